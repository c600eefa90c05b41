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


def test_messages_and_pages_have_the_words_of_the_glossary(checkout: Path) -> None:
    glossary = (checkout / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = {term.lower() for term in re.findall(r"^\*\*(.+?)\.\*\*", glossary, re.MULTILINE)}
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


def test_a_word_of_insiders_is_seen() -> None:
    source = 'def f():\n    """It is taken."""\n    return "the cause was taken back"\n'
    ((line, text),) = texts(source)
    assert (line, WORDS.findall(text)) == (3, ["taken"])
