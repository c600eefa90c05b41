"""Words of what a user reads: the glossary's, and none that only insiders know."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

WORDS = re.compile(r"\b(?:gates?|taken|stands? in|left over|told|courts?)\b", re.IGNORECASE)


def texts(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of every string with a blank in it, but for docstrings."""
    tree = ast.parse(source)
    own = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str) or id(node) in own:
            continue
        if " " in node.value.strip():
            yield node.lineno, node.value


def terms_of(checkout: Path) -> set[str]:
    """What the glossary explains, in small letters."""
    glossary = (checkout / "docs" / "glossary.md").read_text(encoding="utf-8")
    return {term.lower() for term in re.findall(r"^\*\*(.+?)\.\*\*", glossary, re.MULTILINE)}


def test_messages_and_pages_have_the_words_of_the_glossary(checkout: Path) -> None:
    terms = terms_of(checkout)
    found = []
    for path in sorted((checkout / "modelgen").rglob("*.py")):
        for line, text in texts(path.read_text(encoding="utf-8")):
            found += [
                f"{path.relative_to(checkout)}:{line}: '{word}' in {text[:70]!r}"
                for word in WORDS.findall(text)
                if word.lower() not in terms
            ]
    for path in sorted((checkout / "templates" / "report").iterdir()):
        shown = re.sub(r"\{[%{#].*?[%}#]\}|<[^>]*>", " ", path.read_text(encoding="utf-8"))
        found += [f"{path.name}: '{word}'" for word in WORDS.findall(shown)]
    assert not found, "\n".join(found)


def test_the_documentation_has_the_words_of_the_glossary(checkout: Path) -> None:
    terms = terms_of(checkout)
    found = []
    for path in [
        *checkout.glob("*.md"),
        *(checkout / "docs").rglob("*.md"),
        *checkout.glob("examples/*/*.md"),
    ]:
        text = path.read_text(encoding="utf-8")
        prose = re.sub(r"```.*?```|`[^`\n]*`", lambda m: "\n" * m[0].count("\n"), text, flags=re.DOTALL)
        found += [
            f"{path.relative_to(checkout)}:{number}: '{word}'"
            for number, line in enumerate(prose.splitlines(), 1)
            for word in WORDS.findall(line)
            if word.lower().removesuffix("s") not in terms
        ]
    assert not found, "\n".join(found)


# Names of formats and of what a command is given, which are no words of the results.
NO_TERMS = {"FILE", "LOG", "ARMS", "DIR", "YAML", "CSV", "SVG", "HTML", "UTC", "FMU", "URDF", "MJCF"}


def test_what_results_are_measured_in_is_in_the_glossary(checkout: Path) -> None:
    """Abbreviations of the pages and the terminal, and the words of the verdicts."""
    found = {"suspect", "cut-off", "doubt"}
    for package in ("report", "api", "fleet"):
        for path in sorted((checkout / "modelgen" / package).rglob("*.py")):
            for _, text in texts(path.read_text(encoding="utf-8")):
                found |= set(re.findall(r"\b(?:[A-Z]{3,}|F_gof)\b", text)) - NO_TERMS
    assert {"F_gof", "RMSE", "NRMSE", "BIC"} <= found
    terms = terms_of(checkout)
    assert not [word for word in sorted(found) if word.lower() not in terms]


READ = {".c", ".h", ".py", ".sh", ".yaml"}  # what a user opens in examples: comments, texts and all


def test_examples_and_descriptions_have_the_words_of_the_glossary(checkout: Path) -> None:
    """Comments too; the text of a description goes on into what is generated from it."""
    terms = terms_of(checkout)
    files = [p for p in sorted((checkout / "examples").rglob("*")) if p.suffix in READ]
    files = [p for p in files if "build" not in p.relative_to(checkout).parts]  # not what they download
    assert {p.suffix for p in files} >= {".c", ".h", ".py", ".yaml"}
    found = [
        f"{path.relative_to(checkout)}:{number}: '{word}' in {line.strip()[:70]!r}"
        for path in [checkout / "arms.yaml", *files]
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        for word in WORDS.findall(line)
        if word.lower().removesuffix("s") not in terms
    ]
    assert not found, "\n".join(found)


def test_a_word_of_insiders_is_seen() -> None:
    source = 'def f():\n    """It is taken."""\n    return "the cause was taken back"\n'
    ((line, text),) = texts(source)
    assert (line, WORDS.findall(text)) == (3, ["taken"])


def test_every_check_of_a_cause_is_in_the_glossary(checkout: Path) -> None:
    """By the names under which diagnosis.json and the pages have them."""
    source = "".join(p.read_text(encoding="utf-8") for p in (checkout / "modelgen/diagnosis").rglob("*.py"))
    names = set(re.findall(r'\bCheck\(\s*"(\w+)"', source))
    assert {"evidence", "undominated", "confirmed"} <= names
    assert names <= terms_of(checkout)


def docstrings(source: str) -> Iterator[tuple[int, str]]:
    """Line and docstring of a module, its public functions and classes, and their public methods."""

    def below(node: ast.AST) -> Iterator[tuple[int, str]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef | ast.ClassDef) and not child.name.startswith("_"):
                yield child.lineno, ast.get_docstring(child) or ""
                if isinstance(child, ast.ClassDef):
                    yield from below(child)

    tree = ast.parse(source)
    yield 1, ast.get_docstring(tree) or ""
    yield from below(tree)


def keys(source: str) -> Iterator[tuple[int, str]]:
    """Line and words of every key of a dictionary that is written out: what becomes JSON."""
    for node in ast.walk(ast.parse(source)):
        for key in node.keys if isinstance(node, ast.Dict) else ():
            if isinstance(key, ast.Constant) and isinstance(key.value, str) and key.value.isidentifier():
                yield key.lineno, key.value.replace("_", " ")


def test_the_reference_and_the_keys_of_json_have_the_words_of_the_glossary(checkout: Path) -> None:
    """The reference is made of docstrings; those of commands are what --help prints."""
    terms = terms_of(checkout)
    found = []
    for path in sorted((checkout / "modelgen").rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        for line, text in [*docstrings(source), *keys(source)]:
            found += [
                f"{path.relative_to(checkout)}:{line}: '{word}' in {text[:70]!r}"
                for word in WORDS.findall(text)
                if word.lower().removesuffix("s") not in terms
            ]
    assert not found, "\n".join(found)


def test_a_word_of_insiders_is_seen_in_a_docstring_and_in_a_key() -> None:
    source = 'def f():\n    """It is taken."""\n    return {"rest_gates": 1, "taken": 2}\n'
    assert [w for _, text in docstrings(source) for w in WORDS.findall(text)] == ["taken"]
    assert [w for _, text in keys(source) for w in WORDS.findall(text)] == ["gates", "taken"]
