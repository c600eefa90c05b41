"""Commands on the pages: every one has options that exist, and runs where it can."""

from __future__ import annotations

import re
import shutil
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import page_commands
import pytest
from command_support import called
from page_commands import ELSEWHERE, PARSED, ROOT, SHORT, Call
from typer.main import get_command

from modelgen import Arm, build_model, load_arms
from modelgen.cli.app import app
from modelgen.transmission import of_joint

pytestmark = pytest.mark.xdist_group("commands")

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
    "optional-dependencies"
]
# Where `python -m` of the pages finds its module.
PLACES = (ROOT, ROOT / "tests", ROOT / "tests/support", ROOT / "benchmarks")

CALLING = [p for p in page_commands.pages() if any("modelgen " in sh for sh, _ in page_commands.blocks(p))]


def parsed(words: tuple[str, ...]) -> None:
    """A command through the parser of the command line, which raises where it does not know an option."""
    group: Any = get_command(app)
    context = group.context_class(group, info_name="modelgen")
    if words[0].startswith("-"):
        assert any(words[0] in p.opts for p in group.get_params(context))
        return
    name, command, rest = group.resolve_command(context, list(words))
    if "--help" not in rest:
        command.make_context(name, rest, parent=context)


def python_is_there(words: tuple[str, ...]) -> None:
    """A module or a program of the project, whose source has the options."""
    if words[0] == "-m" and words[1] in ("venv", "pytest"):
        return
    if words[0] == "-m":
        parts = words[1].split(".")
        found = [place.joinpath(*parts).with_suffix(".py") for place in PLACES]
        found += [place.joinpath(*parts, "__main__.py") for place in PLACES]
        options = words[2:]
    else:
        found, options = [ROOT / words[0]], words[1:]
    there = [path for path in found if path.is_file()]
    assert there, words
    source = there[0].read_text(encoding="utf-8")
    for option in options:
        assert not option.startswith("--") or option == "--help" or f'"{option}"' in source, option


def target_is_there(words: tuple[str, ...]) -> None:
    """Targets and variables of the Makefile."""
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    for word in words:
        name, _, value = word.partition("=")
        known = f"$({name})" in text if value else re.search(rf"^{name}:(?!=)", text, re.MULTILINE)
        assert known, word


def extras_are_there(words: tuple[str, ...]) -> None:
    """Extras of what is installed."""
    for word in words:
        for extra in re.findall(r"[\w-]+", "".join(re.findall(r"\[(.*)\]", word))):
            assert extra in EXTRAS, word


CHECKS = {
    "modelgen": parsed,
    "python": python_is_there,
    "python3": python_is_there,
    "make": target_is_there,
    "pip": extras_are_there,
}


@pytest.mark.parametrize("page", page_commands.pages())
def test_commands_have_options_that_exist(page: str, tmp_path: Path) -> None:
    for call in page_commands.calls(page, tmp_path):
        check = CHECKS.get(call.words[0])
        if check is not None:
            check(call.words[1:])


def test_a_command_with_an_option_that_there_is_not_is_seen() -> None:
    parsed(("identify", "--arm", "a", "--train", "a.csv", "--out", "found"))
    with pytest.raises(Exception, match="No such option: --weights"):
        parsed(("identify", "--arm", "a", "--train", "a.csv", "--out", "found", "--weights", "1"))
    with pytest.raises(Exception, match=r"Missing.*train"):
        parsed(("identify", "--arm", "a", "--out", "found"))
    with pytest.raises(Exception, match="No such command 'identfy'"):
        parsed(("identfy",))


def test_what_is_said_of_commands_that_are_not_run_is_so(tmp_path: Path) -> None:
    for page, test in ELSEWHERE.items():
        text = (ROOT / test).read_text(encoding="utf-8")
        assert (ROOT / page).is_file()
        assert Path(page).name in text or f'"{Path(page).parent.name}"' in text
    for number, (page, piece, _) in enumerate(PARSED):
        folder = tmp_path / str(number)
        folder.mkdir()
        assert any(piece in " ".join(c.words) for c in page_commands.calls(page, folder)), (page, piece)


def test_the_extras_are_on_the_page_of_installation() -> None:
    page = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `([\w-]+)` \|", page, re.MULTILINE)) == set(EXTRAS)


def _block(page: str, language: str) -> str:
    """The first block of a language on a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return str(re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)[0])


def _motion(file: Path, phase: float) -> None:
    """Ten seconds of two joints, a period twice: two harmonics within the limits of the started arm."""
    t = np.arange(2001) / 200
    middle, swing = np.array([0.3, 0.0]), np.array([0.25, 0.7])
    columns = {"t": t}
    for joint in (0, 1):
        for order, name in enumerate(("q", "dq", "ddq")):
            value = middle[joint] * (order == 0)
            for harmonic, part in ((1, 0.7), (2, 0.3)):
                w, turned = 0.4 * np.pi * harmonic, order * np.pi / 2 + phase * (joint + harmonic)
                value = value + swing[joint] * part * w**order * np.sin(w * t + turned)
            columns[f"{name}{joint + 1}"] = value
    table = np.stack(list(columns.values()), axis=1)
    np.savetxt(file, table, delimiter=",", header=",".join(columns), comments="", fmt="%.9g")


def _marker(file: Path, arm: Arm) -> None:
    """Motor coordinate and measured angle of a lever over its stroke."""
    low, high = of_joint(arm, arm.joints[0]).joint_range() or (0.0, 0.0)
    q = np.zeros((400, 2))
    q[:, 0] = np.linspace(low + 0.05, high - 0.05, 400)
    motor = build_model(arm).functions["motor_from_joint"](q=q, dq=0 * q, ddq=0 * q)[0]
    measured = q[:, 0] + 0.01 * np.random.default_rng(1).normal(size=400)
    table = np.stack([np.arange(400) / 100, motor[:, 0], measured], axis=1)
    np.savetxt(file, table, delimiter=",", header="t,qm1,q1", comments="", fmt="%.9g")


def _simulated(folder: Path, *words: str) -> None:
    done = called("simulate", *words, cwd=folder)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the commands of the pages find: a description, motions, logs, a robot."""
    folder = tmp_path_factory.mktemp("given")
    assert called("init", "digger", cwd=folder).returncode == 0
    path = folder / "arms.yaml"
    text = path.read_text(encoding="utf-8")
    digger = text[text.index("  digger:") :]
    _marker(folder / "marker.csv", load_arms(path)["digger"])
    logs = {"a": 0.0, "b": 1.0, "c": 2.0}
    for log, phase in logs.items():
        _motion(folder / "trajectory.csv", phase)
        sensors = ("--rate", "250", "--noise", "0.005", "--out", f"{log}.csv")
        _simulated(folder, "--control", "pi", "--reference", "trajectory.csv", *sensors)
    for name, log in {"train": "a", "test": "c", "measured": "a"}.items():
        shutil.copy(folder / f"{log}.csv", folder / f"{name}.csv")
    found = called("identify", "--train", "a.csv", "--test", "c.csv", "--out", "found", cwd=folder)
    assert found.returncode == 0, found.stderr
    values = (folder / "found/digger_parameters.yaml").read_text(encoding="utf-8")
    (folder / "my_arm_parameters.yaml").write_text(values.replace("digger", "my_arm"), encoding="utf-8")
    shutil.rmtree(folder / "found")
    loader = _block("docs/from-a-drawing.md", "yaml")
    shipped = (ROOT / "arms.yaml").read_text(encoding="utf-8").rstrip()
    others = [digger, digger.replace("  digger:", "  my_arm:", 1), loader[loader.index("  loader:") :]]
    path.write_text("\n".join([shipped, *others]), encoding="utf-8")
    swings = {"20deg": 20, "30deg": 30, "40deg": 40, "30deg_again": 31, "swing_20": 20, "swing_40": 40}
    for name, angle in swings.items():
        words = ("--q0", f"{angle} deg", "--duration", "4", "--rate", "200", "--out", f"{name}.csv")
        _simulated(folder, "--arm", "gravity_link2", *words)
    (folder / "robot.urdf").write_text(_block("docs/from-a-urdf.md", "xml"), encoding="utf-8")
    (folder / "examples").symlink_to(ROOT / "examples")
    return folder


def _run(call: Call, folder: Path) -> None:
    """A command in a folder, made short, prints what its page says."""
    name, *rest = call.words[1:]
    done = called(name, *rest, *SHORT.get(name, ()), cwd=folder)
    assert done.returncode == 0, (call.words, done.stdout, done.stderr)
    printed = {line.rstrip() for line in (done.stdout + done.stderr).splitlines()}
    assert not [line for line in page_commands.lines(call.printed) if line not in printed], done.stdout


@pytest.mark.parametrize("page", [p for p in CALLING if p not in ELSEWHERE])
def test_commands_run(page: str, given: Path, tmp_path: Path) -> None:
    (tmp_path / "noted").mkdir()
    calls = page_commands.calls(page, tmp_path / "noted")
    run = [call for call in calls if call.words[0] == "modelgen" and not call.reason]
    folder = tmp_path / "here"
    shutil.copytree(given, folder, symlinks=True)
    if any(call.words[1] == "init" for call in run):
        (folder / "arms.yaml").unlink()
    for call in run:
        _run(call, folder)
