"""A fleet: the truth about simulated arms, bad logs as rows, killed and taken up again, on a cluster too."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import command_support
import jsonschema
import pyarrow.parquet
import pytest
from command_support import Done
from hidden.cases import Case, Hidden, make
from jobs_support import cluster
from ruamel.yaml import YAML

from modelgen.effects import CATALOGUE
from modelgen.errors import InputError
from modelgen.fleet.diagnosing import Job, crashed
from modelgen.fleet.overview import overview
from modelgen.fleet.run import diagnose_fleet
from modelgen.fleet.schema import fleet_json_schema
from modelgen.fleet.sentences import differences
from modelgen.fleet.store import kept, read
from modelgen.fleet.units import Unit, load_fleet
from modelgen.jobs import Where

pytestmark = pytest.mark.xdist_group("dask")
FLEET = """schema: 1
units:
  - name: zero
    arms: logs/one/arms.yaml
    arm: <b>nobody</b>
    train: logs/one/train_a.csv
    test: logs/one/test.csv
patterns:
  - arms: "logs/{unit}/arms.yaml"
    train: "logs/{unit}/train_?.csv"
    test: "logs/{unit}/test.csv"
"""
NAMES = ["zero", "broken", "one", "two", "without"]
TIMES = ("seconds", "cpu_seconds")


def fleet(file: Path, out: Path, *more: str) -> list[str]:
    return [sys.executable, "-m", "modelgen", "fleet", str(file), "--out", str(out), *more]


def here(file: Path, out: Path, *more: str) -> Done:
    """As called in a process of its own, where nothing but the answer is asked for."""
    return command_support.called("fleet", file, "--out", out, *more)


def called(file: Path, out: Path, *more: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2])}
    return subprocess.run(
        fleet(file, out, *more), capture_output=True, text=True, check=False, timeout=200, env=environment
    )


def table(out: Path) -> list[dict[str, object]]:
    rows = pyarrow.parquet.read_table(out / "fleet.parquet").to_pylist()
    return [{key: value for key, value in row.items() if key not in TIMES} for row in rows]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Friction of Stribeck in one, nothing in two; a log with a word, and a unit without a test record."""
    folder = tmp_path_factory.mktemp("fleet")
    stribeck = (Hidden("stribeck_friction", 2, 1.3, 0.6),)
    make(Case("direct2", 9002, stribeck, rate=250.0, periods=2), folder / "logs" / "one")
    make(Case("direct2", 9001, (), rate=250.0, periods=2), folder / "logs" / "two")
    for name in ("broken", "without"):
        shutil.copytree(folder / "logs" / "two", folder / "logs" / name)
    broken = folder / "logs" / "broken" / "train_b.csv"
    lines = broken.read_text(encoding="ascii").splitlines()
    broken.write_text("\n".join([*lines[:100], "1,word,2,3,4", *lines[100:]]) + "\n", encoding="ascii")
    (folder / "logs" / "without" / "test.csv").unlink()
    (folder / "fleet.yaml").write_text(FLEET, encoding="utf-8")
    return folder / "fleet.yaml"


@pytest.fixture(scope="module")
def out(file: Path) -> Path:
    """Of an uninterrupted call."""
    answer = called(file, file.parent / "out", "--jobs", "2")
    assert answer.returncode == 1, answer.stderr
    assert "5 units: 1 cause named, 1 nothing missing, 3 failed" in answer.stdout
    assert answer.stderr.count("failed:") == 3
    return file.parent / "out"


def test_every_unit_has_its_row(out: Path) -> None:
    rows = {str(row["unit"]): row for row in table(out)}
    assert list(rows) == NAMES
    assert (rows["one"]["verdict"], rows["two"]["verdict"]) == ("named", "nothing_missing")
    assert (rows["one"]["causes"], rows["one"]["joints"]) == (["stribeck_friction"], [2])
    assert rows["two"]["causes"] == []
    assert rows["one"]["train"] == ["logs/one/train_a.csv", "logs/one/train_b.csv"]


def test_a_row_says_what_its_diagnosis_says(out: Path) -> None:
    (row,) = (row for row in table(out) if row["unit"] == "one")
    said = json.loads((out / "units" / "one" / "diagnosis.json").read_text(encoding="utf-8"))
    (cause,) = said["causes"]
    assert row["delta_bic"] == [cause["evidence"]["delta_bic"]]
    assert row["gain_percent"] == said["error"]["gain_percent"]
    assert row["lack_of_fit"] == said["lack_of_fit"]["statistic"]
    values = {p["name"]: p["value"] for p in row["cause_parameters"]}  # type: ignore[attr-defined]
    assert values == {name: p["value"] for name, p in cause["parameters"].items()}


def test_a_bad_log_is_a_row(out: Path) -> None:
    rows = {str(row["unit"]): row for row in table(out)}
    for name, said in {
        "broken": r"^logs/broken/train_b\.csv:101.*word",
        "without": "^found no test record",
        "zero": "^logs/one/arms.yaml: found no arm '<b>nobody</b>'",
    }.items():
        assert rows[name]["verdict"] is None
        assert re.search(said, str(rows[name]["error"])), rows[name]["error"]
        assert sorted(path.name for path in (out / "units" / name).iterdir()) == ["unit.json"]


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [value or "" for name, value in attrs if name in ("href", "src") and tag != "use"]


def test_the_overview_stands_alone_and_links_to_the_reports(out: Path) -> None:
    text = (out / "overview.html").read_text(encoding="utf-8")
    found = Links()
    found.feed(text)
    outwards = [link for link in found.links if not link.startswith("#")]
    assert list(dict.fromkeys(outwards)) == ["units/one/report.html", "units/two/report.html"]
    assert all((out / link).is_file() for link in outwards)
    assert found.tags.count("tr") - text.count('<th scope="row">') == 3 + len(NAMES)  # of three tables
    assert "<b>nobody" not in text
    assert "stribeck_friction at j2" in text


def test_killed_in_the_middle_and_taken_up_on_a_cluster(file: Path, out: Path, tmp_path: Path) -> None:
    other = tmp_path / "out"
    running = subprocess.Popen(
        fleet(file, other, "--jobs", "1"), start_new_session=True, stderr=subprocess.PIPE
    )
    first = other / "units" / "one" / "unit.json"
    for _ in range(2400):
        if first.exists():
            break
        time.sleep(0.05)
    os.killpg(running.pid, signal.SIGKILL)
    running.communicate()
    before = first.stat()
    there = {path.name for path in (other / "units").iterdir() if not path.name.startswith(".")}
    assert "two" not in there
    assert not list(other.glob("fleet.parquet"))
    assert not list(other.glob("overview.html"))
    (other / "units" / ".two.new").mkdir(exist_ok=True)  # what it was writing
    with cluster(tmp_path) as address:
        answer = called(file, other, "--dask", address, "--json")
    assert answer.returncode == 1, answer.stderr
    said = json.loads(answer.stdout)
    assert said["kept"] == len(there)
    assert said["verdicts"]["failed"] == 3
    after = first.stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert table(other) == table(out)
    assert sorted(path.name for path in (other / "units").iterdir()) == sorted(NAMES)
    names = ["diagnosis.json", "report.html", "effort.svg", "arm_extended.yaml"]
    for unit in ("one", "two"):
        for name in names:
            # the page's commands name the folder
            here, there_ = (
                (folder / "units" / unit / name).read_bytes().replace(str(folder).encode(), b"OUT")
                for folder in (out, other)
            )
            assert here == there_, f"{unit}/{name}"


def test_what_has_not_changed_is_kept_and_what_has_is_made_anew(
    file: Path, out: Path, tmp_path: Path
) -> None:
    again = tmp_path / "fleet"
    shutil.copytree(file.parent, again)
    page = (again / "out" / "overview.html").read_bytes()
    log = again / "logs" / "broken" / "train_b.csv"
    log.write_text(log.read_text(encoding="ascii").replace("word", "WORD"), encoding="ascii")
    answer = here(again / "fleet.yaml", again / "out", "--json", "--jobs", "1")
    said = json.loads(answer.stdout)
    assert said["kept"] == 4  # all but the one whose log has changed
    (error,) = (failed["error"] for failed in said["failed"] if failed["unit"] == "broken")
    assert "WORD" in error
    assert (again / "out" / "overview.html").read_bytes() != page
    more = json.loads(here(again / "fleet.yaml", again / "out", "--json", "--again", "-j", "1").stdout)
    assert more["kept"] == 2
    assert more["failed"] == said["failed"]
    for name in ("broken", "without"):
        shutil.rmtree(again / "logs" / name)
    text = FLEET[: FLEET.index("units:")] + FLEET[FLEET.index("patterns:") :]
    (again / "fleet.yaml").write_text(text, encoding="utf-8")
    answer = here(again / "fleet.yaml", again / "out", "--json")
    assert answer.returncode == 0  # of a fleet in which none failed
    assert json.loads(answer.stdout)["kept"] == 2


def test_a_unit_that_ended_its_process_is_tried_again(file: Path, tmp_path: Path) -> None:
    unit = load_fleet(file)[NAMES.index("two")]
    row = crashed(Job(unit, str(tmp_path)))
    assert "out of memory" in row["error"]
    assert read(tmp_path, "two") is not None
    assert kept(unit, tmp_path) is None


def test_a_fleet_of_which_nothing_can_be_diagnosed(file: Path, tmp_path: Path) -> None:
    text = FLEET[: FLEET.index("patterns:")]
    shutil.copytree(file.parent / "logs" / "one", tmp_path / "logs" / "one")
    (tmp_path / "fleet.yaml").write_text(text, encoding="utf-8")
    answer = here(tmp_path / "fleet.yaml", tmp_path / "out", "-j", "1")
    assert answer.returncode == 2
    assert "no unit of" in answer.stderr
    assert len(table(tmp_path / "out")) == 1


def names(folder: Path, text: str, *files: str) -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    for name in files:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    (folder / "fleet.yaml").write_text(f"schema: 1\narms: arms.yaml\n{text}", encoding="utf-8")
    return {unit.name: (unit.train, unit.test) for unit in load_fleet(folder / "fleet.yaml")}


def test_units_in_flat_files_and_parts_of_one_file(tmp_path: Path) -> None:
    found = names(
        tmp_path,
        "patterns:\n  - train: ['{unit}_a.csv', '{unit}_b*.csv@2:8']\n    test: '{unit}_t.csv'\n"
        "  - train: parts/{unit}.csv@0:45\n    test: parts/{unit}.csv@45:60\n",
        *("n1_a.csv", "n1_b1.csv", "n1_b2.csv", "n1_t.csv", "n2_a.csv", "parts/p.csv"),
    )
    assert found == {
        "n1": (("n1_a.csv", "n1_b1.csv@2:8", "n1_b2.csv@2:8"), ("n1_t.csv",)),
        "n2": (("n2_a.csv",), ()),
        "p": (("parts/p.csv@0:45",), ("parts/p.csv@45:60",)),
    }


def test_the_name_of_a_unit_may_stand_in_folder_and_file(tmp_path: Path) -> None:
    found = names(
        tmp_path,
        "patterns:\n  - train: '{unit}/{unit}_a.csv'\n    test: '{unit}/{unit}_t.csv'\n",
        *("x/x_a.csv", "x/x_t.csv", "y/x_a.csv"),
    )
    assert found == {"x": (("x/x_a.csv",), ("x/x_t.csv",))}


def test_the_example_of_the_documentation_is_a_fleet(checkout: Path, tmp_path: Path) -> None:
    text = (checkout / "docs" / "fleet.md").read_text(encoding="utf-8")
    text = text[text.index("```yaml\n") + 8 :]
    text = text[: text.index("```")]
    jsonschema.validate(YAML(typ="safe", pure=True).load(text), fleet_json_schema())
    for name in ("logs/a17/train_1.csv", "logs/a17/test.csv", "short/b2.csv"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "fleet.yaml").write_text(text, encoding="utf-8")
    found = {unit.name: unit for unit in load_fleet(tmp_path / "fleet.yaml")}
    assert list(found) == ["workshop", "yard", "a17", "b2"]
    assert found["yard"].arm == "digger_long"
    assert found["a17"].train == ("logs/a17/train_1.csv",)
    assert (found["b2"].description, found["b2"].test) == ("arms/b2.yaml", ("short/b2.csv@45:60",))


def test_what_a_unit_says_goes_before_what_all_share(tmp_path: Path) -> None:
    (tmp_path / "fleet.yaml").write_text(
        "schema: 1\narms: a.yaml\narm: one\ncutoff: 12\nunits:\n"
        "  - {name: u, train: a.csv, test: b.csv, arm: two, period: 20/2}\n",
        encoding="utf-8",
    )
    (unit,) = load_fleet(tmp_path / "fleet.yaml")
    assert unit == Unit("u", str(tmp_path), "a.yaml", "two", ("a.csv",), ("b.csv",), None, 12.0, 10.0)


UNIT = "{name: u, arms: a.yaml, train: a.csv, test: b.csv"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the file is empty"),
        ("schema: 1", r"fleet\.yaml:1:1: found no units"),
        ("schema: 2\nunits: []", r":1:9: schema: found 2, expected 1"),
        ("schema: 1\nunit: []", r":2:1: unit: found the unknown key 'unit', did you mean 'units'"),
        (f"schema: 1\nunits:\n  - {UNIT}}}\n  - {UNIT}}}", r":4:5: .*a second unit has the name 'u'"),
        (f"schema: 1\nunits: [{UNIT}, cutoff: -3}}]", r"cutoff: found -3, expected a number above 0"),
        (f"schema: 1\nunits: [{UNIT}, period: ten}}]", r"period: found 'ten', expected a number"),
        (
            "schema: 1\nunits: [{name: ../u, arms: a, train: a, test: b}]",
            r"name: found '\.\./u', expected a name",
        ),
        ("schema: 1\nunits: [{name: u, train: a.csv, test: b.csv}]", "the key 'arms' is missing"),
        ("schema: 1\nunits: [{name: u, arms: a.yaml, test: b.csv}]", "the key 'train' is missing"),
        (
            "schema: 1\narms: a\npatterns: [{train: x*.csv, test: y.csv}]",
            r"train: found 'x\*\.csv', expected \{unit\}",
        ),
        (
            "schema: 1\narms: a\npatterns: [{train: '{unit}.x', test: '{unit}.y'}]",
            "no file matches {unit}.x or",
        ),
        ("schema: 1\nconvention: khalil_kleinfinger", "this is the description of an arm"),
        ("schema: 1\nunits: 3", r"units: found 3, expected a list"),
        ("- a", "found a list of 1, expected a mapping"),
    ],
)
def test_a_mistake_in_the_file_has_its_place(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "fleet.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said) as error:
        load_fleet(tmp_path / "fleet.yaml")
    assert "\n" not in str(error.value)
    assert re.search(r"fleet\.yaml:\d+:\d+: ", str(error.value))


def test_bad_input_on_the_command_line_writes_nothing(file: Path, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.touch()
    for arguments, said in (
        ((tmp_path / "no.yaml", tmp_path / "out"), "there is no such fleet file"),
        ((file, taken), "found a file, expected a folder"),
    ):
        answer = here(*arguments)
        assert answer.returncode == 2
        assert said in answer.stderr
        assert len(answer.stderr.splitlines()) == 1
        assert not (tmp_path / "out").exists()


def test_without_pyarrow(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(InputError, match="a fleet needs pyarrow: pip install 'pyarrow"):
        diagnose_fleet(load_fleet(file), tmp_path / "out", Where(1))
    assert not (tmp_path / "out").exists()


def test_a_cluster_that_is_not_reached_leaves_nothing(file: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--dask: found 'mars', expected an address"):
        diagnose_fleet(load_fleet(file), tmp_path / "out", Where(dask="mars"))
    assert not (tmp_path / "out").exists()


def test_names_of_effects_are_read_as_they_are() -> None:
    named = {"causes": ["load_dependent_friction"], "joints": [1], "joint_names": ["j1"]}
    named["ambiguous_with"] = [[]]
    text = overview([{"unit": "u", "arm": "a", "verdict": "named", **named}])
    assert "&lt;wbr&gt;" not in text
    assert "load_<wbr>dependent_<wbr>friction" in text


def test_words_of_a_log_are_no_markup() -> None:
    text = overview([{"unit": "u", "arm": "a", "error": "<script>alert(1)</script> & more"}])
    assert "<script>alert" not in text
    assert "&lt;script&gt;alert(1)" in text


def rows_of(verdict: str, *units: str, **more: object) -> list[dict[str, object]]:
    return [
        {"unit": unit, "arm": "digger", "verdict": verdict, "reason": f"why {unit}"} | more for unit in units
    ]


SPRING = {"causes": ["spring"], "joints": [2], "joint_names": ["elbow"], "ambiguous_with": [[]]}


def test_the_overview_says_first_which_units_differ_and_by_what() -> None:
    usual = rows_of("nothing_missing", "u1", "u2", "u3", "u4", "u5")
    lacking = rows_of("named", "u6", **SPRING)
    assert differences([*usual, *lacking]) == [
        "5 of 6 units lack nothing that their records could show.",
        "`u6` differs: a spring acts at elbow.",
    ]
    assert differences(usual) == ["All 5 units lack nothing that their records could show."]
    several = [*usual, *lacking, *rows_of("named", "u7", **SPRING), *rows_of("failed", "u8")]
    assert differences(several)[1:] == [
        "`u6` and `u7` differ: a spring acts at elbow.",
        "`u8` differs: it could not be diagnosed.",
    ]
    suspect = rows_of("suspected", "u9", suspects=["presliding at elbow"], failed_checks=[["form"]])
    assert differences([*lacking, *suspect]) == [
        "In `u6` a spring acts at elbow.",
        "In `u9` perhaps friction in the drive of elbow builds up over a distance after each reversal.",
    ]
    text = overview([*usual, *lacking])
    assert text.index("5 of 6 units lack nothing that their records could show.") < text.index(
        "<caption>"
    )  # in words, then in bars


@pytest.mark.parametrize("effect", CATALOGUE)
def test_a_fleet_says_every_effect_in_words_without_values(effect: str) -> None:
    """In a sentence that has the joints and neither the effect's name nor a value."""
    named = {"causes": [effect], "joints": [2], "joint_names": ["elbow"], "ambiguous_with": [[]]}
    titles = [f"{effect} at elbow and wrist"]
    (said,) = differences(rows_of("named", "u1", "u2", "u3", **named, titles=titles))
    assert re.fullmatch(r"In all 3 units [a-z' ]+\.", said)
    assert "elbow" in said or CATALOGUE[effect].scope == "arm"
    assert ("wrist" in said) == ("{other}" in CATALOGUE[effect].finding)
    assert "  " not in said


def test_of_many_causes_the_first_are_said_in_words() -> None:
    many = ["spring at elbow", "presliding at elbow", "spring at wrist", "backlash at wrist", "made_up at j"]
    perhaps = rows_of("suspected", "u1", "u2", suspects=many[:1])
    assert differences([*perhaps, *rows_of("nothing_missing", "u3")]) == [
        "In 2 of 3 units perhaps a spring acts at elbow.",
        "`u3` differs: it lacks nothing that its records could show.",
    ]
    (said,) = differences(rows_of("suspected", "u1", suspects=many, failed_checks=[["form"]] * 5))
    assert said.endswith("a spring acts at wrist and 2 more, in the table.")
    assert differences(rows_of("suspected", "u1", suspects=many[4:])) == ["In `u1` perhaps made_up at j."]


def copied(text: str) -> list[str]:
    """The commands of a page, as they are copied."""
    return re.findall(r"<pre><code>(.*?)</code>", text)


def test_what_remains_beside_a_cause_is_to_be_looked_at_and_how_sure_it_is_said() -> None:
    fit = {"lack_of_fit": 20.0, "lack_of_fit_threshold": 1.25, "delta_bic": [289.3]}
    far = rows_of("named", "far", **SPRING, **fit)
    near = rows_of("named", "near", **SPRING, **fit | {"lack_of_fit": 1.0, "delta_bic": [30.0]})
    text = overview([*far, *near])
    said = " ".join(re.sub("<[^>]*>", "", text).split())
    assert "far: something deterministic remains beside what is named, lack of fit / threshold 16" in said
    assert "near: something" not in said
    assert "Each of the 2 causes passed every check that decides; evidence (delta BIC) 30 to 289;" in said
    assert "<code>far</code> and <code>near</code>" in text
    rival = rows_of("named", "u", **SPRING | {"ambiguous_with": [["base_tilt"]]})
    assert "1 of 1 has a rival" in overview(rival)


def test_a_named_unit_says_its_worth_its_doubts_and_its_suspects() -> None:
    """The joint that lost, what differs between its records, and what is suspected beside the cause."""
    lost = "8.0 % less error on the test record over all joints (5.0 to 11.0 %), 2.0 % more at boom."
    unstable = "Not stable, the training records differ in the size of spring at elbow."
    row = SPRING | {"worth": lost, "doubts": [unstable], "overall_gain_percent": 8.0}
    (one,) = rows_of("named", "u", **row, suspects=["presliding at boom"], failed_checks=[["form"]])
    text = " ".join(re.sub("<[^>]*>", " ", overview([one])).split())
    assert "digger: fleet of 1 unit" in text
    worth = text.index("What it is worth")
    after = text.index("What to look at next", worth)
    assert worth < text.index(lost) < after < text.index(unstable)
    assert "Suspected too: presliding at boom failed the check form." in text
    several = overview([one, *rows_of("named", "other", **SPRING | {"overall_gain_percent": 4.0})])
    assert "median of 2 units" in several
    assert lost in several


def test_the_table_of_units_has_no_empty_column() -> None:
    """Where nothing is named there are no causes and no evidence; what sorts as a number says so itself."""
    heads = re.compile(r"<th scope=\"col\"[^>]*>(?:<[^>]*>)?([^<]*)<")
    plain = overview([row | {"seconds": 3.0} for row in rows_of("nothing_missing", "u1", "u2")])
    assert heads.findall(plain)[-5:] == ["unit", "arm", "verdict", "s", "reason"]
    named = overview(rows_of("named", "u", **SPRING, delta_bic=[41.0], overall_gain_percent=4.0))
    assert heads.findall(named)[-7:] == [
        "unit",
        "arm",
        "verdict",
        "causes",
        "delta BIC",
        "less error %",
        "reason",
    ]
    assert named.count(" data-number") == 3  # verdict, evidence, error
    for text in (plain, named):
        table = text[
            text.index('<table id="units"') : text.index("</table>", text.index('<table id="units"'))
        ]
        sizes = {row.count("<td ") for row in table.split("<tr")[2:]}
        assert sizes == {len(heads.findall(table))}


def test_the_overview_has_the_next_command_and_says_nothing_twice() -> None:
    wanting = [
        *rows_of("failed", "f", error="f.csv: there is no such log"),
        *rows_of("cannot_tell", "c", next="Record a motion. This computes one:", command="modelgen excite a"),
        *rows_of("suspected", "s", suspects=["spring at elbow", "presliding at elbow"],
                 failed_checks=[["form"], ["form"]], next="Record another:", command="modelgen excite b"),
    ]  # fmt: skip
    named = rows_of("named", "n", **SPRING, next="Generate the code:", command="modelgen generate n")
    text = overview([*named, *wanting])
    assert copied(text) == ["modelgen excite b"]  # of the first that wants one
    assert "record another:" in text
    assert "f: failed, f.csv: there is no such log" in text
    for once in ("why c", "why n"):
        assert text.count(once) == 1
    assert text.count("failed the check form") == 1
    assert copied(overview(named)) == ["modelgen generate n"]
    assert "The pages of the others have theirs." in text
    assert "have theirs" not in overview([*named, *rows_of("failed", "f", error="x")])  # which have none
    again = "modelgen fleet fleet.yaml --out found --again"
    assert copied(overview(wanting, again)) == [again, "modelgen excite b"]
    assert again not in overview(named, again)  # nothing failed
    assert "<pre>" not in overview(rows_of("nothing_missing", "kept"))  # of a fleet before this
