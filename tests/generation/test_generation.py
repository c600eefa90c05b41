"""What is generated depends on the description alone, and says where it comes from."""

import hashlib
import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from arms_support import ARMS
from backends_support import planar_model

from modelgen import __version__
from modelgen.description import loads
from modelgen.errors import InputError, Location
from modelgen.functions import Options
from modelgen.generation import generate, generate_arm, print_model, refuse_collisions
from modelgen.generation.arm import shown_options
from modelgen.generation.canonical import canonical, description_hash

ROOT = Path(__file__).parents[2]
SMALL = ["gravity_link1", "screw_axis", "gravity_arm"]

YAML = """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    symbols: {a: 0.2}
    joints:
      - {name: j1, alpha: pi/2, d: a, r: 0, drive: {type: direct, ratio: 50, torque_constant: 0.02}}
"""
SAME = """
# Other layout, other order, other spelling of the same numbers.
convention: khalil_kleinfinger
schema: 1
arms:
  one:
    joints:
      - name: j1
        d: a
        alpha: 90 deg
        drive: {torque_constant: 2.0e-2, ratio: 50.0, type: direct}
    symbols: {a: 200 mm}
"""


def content(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_the_same_arm_written_otherwise_has_the_same_hash() -> None:
    assert canonical(loads(YAML)["one"]) == canonical(loads(SAME)["one"])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("a: 0.2", "a: 0.2000000001"),
        ("d: a", "d: 0.2"),
        ("ratio: 50", "ratio: 51"),
        ("r: 0", "r: 0.1"),
        ("type: direct, ratio: 50, torque_constant: 0.02", "type: none"),
        ("joints:", "gravity: [0, 0, 0]\n    joints:"),
        ("joints:", "source: me\n    joints:"),
    ],
)
def test_any_change_of_the_arm_changes_its_hash(old: str, new: str) -> None:
    assert old in YAML
    assert description_hash(loads(YAML.replace(old, new))["one"]) != description_hash(loads(YAML)["one"])


def test_the_place_in_the_file_is_no_part_of_the_arm() -> None:
    arm = loads(YAML)["one"]
    assert arm.where is not None
    moved = replace(arm, where=Location("elsewhere.yaml", 99, 1))
    assert description_hash(moved) == description_hash(arm)


def test_the_manifest_lists_every_file_with_its_hash(tmp_path: Path) -> None:
    generate([ARMS["gravity_arm"]], tmp_path, Options(), processes=1)
    written = content(tmp_path / "gravity_arm")
    manifest = json.loads(written.pop("manifest.json"))
    assert manifest["arm"] == "gravity_arm"
    assert manifest["tool"] == f"modelgen {__version__}"
    assert manifest["description_sha256"] == description_hash(ARMS["gravity_arm"])
    assert manifest["files"] == {name: hashlib.sha256(data).hexdigest() for name, data in written.items()}
    for name, data in written.items():
        assert manifest["description_sha256"][:16].encode() in data, name


def test_no_file_holds_a_date_or_a_path(tmp_path: Path) -> None:
    generate([ARMS["gravity_arm"]], tmp_path, Options(), processes=1)
    for name, data in content(tmp_path).items():
        text = data.decode()
        assert not re.search(r"\b20\d\d-\d\d-\d\d\b|\b\d\d:\d\d:\d\d\b", text), name
        assert str(tmp_path) not in text, name
        assert str(Path.cwd()) not in text, name
        assert text.endswith("\n"), name
        assert "\r" not in text, name
        assert not re.search(r"(?m)[ \t]+$", text), f"{name} has blanks at the end of a line"


def test_processes_do_not_show(tmp_path: Path) -> None:
    arms = [ARMS[name] for name in SMALL]
    seen: list[str] = []
    generate(arms, tmp_path / "one", Options(), processes=1)
    generate(arms, tmp_path / "many", Options(), processes=3, progress=seen.append)
    assert content(tmp_path / "one") == content(tmp_path / "many")
    assert seen == SMALL


def test_a_script_generates_several_arms_without_a_guard_for_its_children(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "import modelgen as mg\n"
        f"every = mg.load_arms({str(ROOT / 'arms.yaml')!r})\n"
        f"two = [every[name] for name in {SMALL[:2]}]\n"
        "print(len(mg.generate(two, 'out', generation=mg.GenerationOptions(processes=2)).arms))\n",
        encoding="utf-8",
    )
    call = [sys.executable, str(script)]
    ended = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "2\n", "")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted(SMALL[:2])


def test_nothing_is_written_where_one_arm_fails(tmp_path: Path) -> None:
    bad = replace(ARMS["gravity_arm"], name="bad")
    options = Options(jacobian_link="j1")  # a link that the other arms have
    assert bad.joints[0].name == "j1"
    lone = replace(ARMS["gravity_link1"], joints=(replace(ARMS["gravity_link1"].joints[0], name="other"),))
    for processes in (1, 2):
        with pytest.raises(InputError, match="j1"):
            generate([bad, lone], tmp_path / "out", options, processes=processes)
        assert not (tmp_path / "out").exists()


def test_other_arms_in_the_folder_stay(tmp_path: Path) -> None:
    generate([ARMS["gravity_arm"]], tmp_path, Options(), processes=1)
    before = content(tmp_path)
    generate([ARMS["screw_axis"]], tmp_path, Options(), processes=1)
    assert before.items() <= content(tmp_path).items()


def test_a_check_finds_each_kind_of_drift_and_writes_nothing(tmp_path: Path) -> None:
    arms = [ARMS["gravity_arm"], ARMS["screw_axis"]]
    generate(arms, tmp_path, Options(), processes=1)
    assert generate(arms, tmp_path, Options(), check=True, processes=1).drift == ()
    changed = tmp_path / "gravity_arm" / "src" / "gravity_arm_bias.c"
    changed.write_text(changed.read_text() + "\n")
    (tmp_path / "gravity_arm" / "include" / "gravity_arm.h").unlink()
    (tmp_path / "screw_axis" / "notes.txt").write_text("mine")
    before = content(tmp_path)
    drift = generate(arms, tmp_path, Options(), check=True, processes=1).drift
    assert [(d.path.relative_to(tmp_path).as_posix(), d.kind) for d in drift] == [
        ("gravity_arm/include/gravity_arm.h", "missing"),
        ("gravity_arm/src/gravity_arm_bias.c", "changed"),
        ("screw_axis/notes.txt", "extra"),
    ]
    assert content(tmp_path) == before
    generate(arms, tmp_path, Options(), processes=1)
    assert generate(arms, tmp_path, Options(), check=True, processes=1).drift == ()


def test_a_check_sees_a_changed_description(tmp_path: Path) -> None:
    arm = ARMS["gravity_arm"]
    generate([arm], tmp_path, Options(), processes=1)
    heavier = replace(arm, gravity=(0.0, 0.0, -1.62))
    drift = generate([heavier], tmp_path, Options(), check=True, processes=1).drift
    assert {"changed"} == {d.kind for d in drift}
    assert {"manifest.json", "gravity_arm.h", "gravity_arm_gravity.c"} <= {d.path.name for d in drift}


def test_arms_that_differ_in_case_alone_are_refused(tmp_path: Path) -> None:
    one = ARMS["gravity_link1"]
    with pytest.raises(
        InputError, match="'gravity_link1' and 'Gravity_Link1' would share a folder and C names"
    ):
        generate([one, replace(one, name="Gravity_Link1")], tmp_path / "out", Options(), processes=1)
    assert not (tmp_path / "out").exists()


def test_arms_whose_names_meet_in_c_are_refused() -> None:
    arms = [planar_model(name).arm for name in ("a", "b")]
    first, second = (print_model(planar_model(arm.name), arm, {}) for arm in arms)
    refuse_collisions(arms, [first, second])
    assert "a_gravity" in first.symbols
    meeting = replace(second, symbols=second.symbols | {"a_gravity"})
    with pytest.raises(InputError, match="'a' and 'b' would both define 'a_gravity' in C; rename one"):
        refuse_collisions(arms, [first, meeting])


def test_the_shipped_arms_share_no_name_in_c() -> None:
    arms = [ARMS[name] for name in SMALL]
    generated = [generate_arm(arm, Options()) for arm in arms]
    refuse_collisions(arms, generated)
    for arm in generated:
        assert f"{arm.name}_inverse_dynamics" in arm.symbols
        assert f"{arm.name}_n_joints" in arm.symbols


def test_a_constant_too_large_for_float_is_an_error_in_the_description() -> None:
    arm = loads(YAML.replace("a: 0.2", "a: 1e30"), "far.yaml")["one"]
    with pytest.raises(InputError, match=r"far.yaml:5:3: one: the constant .* out of the range of single"):
        generate_arm(
            replace(arm, symbols={}, joints=(replace(arm.joints[0], theta=1e60, d=1e50),)), Options()
        )


def test_options_are_stated_in_the_files() -> None:
    assert shown_options(Options()) == {}
    options = Options(without=frozenset({"effects", "drives"}), gains="row_wise", runtime_geometry=True)
    stated = {"without": "drives and effects", "gains": "row_wise", "geometry": "at run time"}
    assert shown_options(options) == stated
    made = generate_arm(ARMS["gravity_arm"], replace(options, runtime_geometry=False))
    assert "without: drives and effects, gains: row_wise" in made.files["include/gravity_arm.h"]
    assert (
        made.files["src/gravity_arm_gravity.c"]
        != generate_arm(ARMS["gravity_arm"], Options()).files["src/gravity_arm_gravity.c"]
    )


def test_templates_hold_no_arithmetic(checkout: Path) -> None:
    """What stands between braces is a name, a loop or a condition on a name."""
    found = sorted((checkout / "templates").rglob("*.j2"))
    assert len(found) >= 4
    allowed = re.compile(
        r"(\{\{ [a-z_.]+( if loop\.first)? \}\}|\{\{ '\"\"\"' if loop\.first \}\}"
        r"|\{% (for [a-z_, ]+ in [a-z_.]+|endfor|if [a-z_.]+|endif) %\})"
    )
    for path in found:
        text = path.read_text(encoding="utf-8")
        tags = re.findall(r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}", text, re.DOTALL)
        assert tags
        wrong = [tag for tag in tags if not allowed.fullmatch(tag)]
        assert not wrong, f"{path.name}: {wrong}"
