"""The commands on the pages, copied as they stand: they run in the folder in which modelgen was called."""

import json
import re
import shlex
from contextlib import chdir
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_support import called
from copied_commands import SHORT, commands, parsed, run
from diagnosis_support import record
from typer.main import get_command

import modelgen as mg
from modelgen.api.diagnosis import Diagnosis
from modelgen.calibration.lever import lever_of
from modelgen.cli.app import app
from modelgen.options import DiagnosisOptions, ExcitationOptions, words_of
from modelgen.report.call import Call
from modelgen.report.following import proposed, replaying

# The arm of diagnosis_support, with the effort in mA and without a limit of speed.
DESCRIPTION = """schema: 1
convention: khalil_kleinfinger
arms:
  bench:
    gravity: [0, -9.81, 0]
    joints:
      - {name: shoulder, drive: {type: direct, ratio: 80, torque_constant: 0.05}}
      - {name: elbow, d: 0.45, antecedent: shoulder, drive: {type: direct, ratio: 60, torque_constant: 0.04}}
"""
MAPPING = """schema: 1
hold: instant
joints:
  - {position: {column: q1, unit: rad}, effort: {column: i1, unit: mA}}
  - {position: {column: q2, unit: rad}, effort: {column: i2, unit: mA}}
"""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a description, a mapping and three logs, and what identify makes of two of them."""
    folder = tmp_path_factory.mktemp("bench")
    (folder / "logs of may").mkdir()
    (folder / "my arm.yaml").write_text(DESCRIPTION, encoding="utf-8")
    (folder / "columns.yaml").write_text(MAPPING, encoding="utf-8")
    for k, name in enumerate(("one", "two", "test")):
        r = record("friction_offset", 2, 0.5, k, name)
        assert r.input is not None
        table = np.column_stack([r.t, r.q, 1e3 * r.input])
        path = folder / "logs of may" / f"{name}.csv"
        np.savetxt(path, table, fmt="%.9g", delimiter=",", header="t,q1,q2,i1,i2", comments="")
    logs = ["--train", "logs of may/one.csv", "--train", "logs of may/two.csv", "--test"]
    logs += ["logs of may/test.csv", "--mapping", "columns.yaml", "--cutoff", "7.5"]
    run(["identify", "my arm.yaml", *logs, "--out", "what was found"], folder)
    return folder


def test_what_identify_and_diagnose_propose_runs_as_it_is_copied(bench: Path) -> None:
    found = {words[0]: words for words in commands(bench / "what was found" / "report.html")}
    assert {"generate", "diagnose"} <= found.keys() <= {"generate", "diagnose", "excite"}
    for words in found.values():
        assert words[1] == "my arm.yaml"
        parsed(words, bench)
    asked = parsed(found["diagnose"], bench)
    assert asked["train"] == ["logs of may/one.csv", "logs of may/two.csv"]
    assert (asked["mapping"], asked["cutoff"]) == (Path("columns.yaml"), 7.5)
    run(found["generate"], bench)
    assert (bench / "generated" / "bench" / "include" / "bench.h").is_file()
    run(found["diagnose"], bench)
    ((generate, *words),) = commands(bench / "what was found" / "diagnosis" / "report.html")
    parsed([generate, *words], bench)
    run([generate, *words, "--out", "extended code"], bench)
    asked_about = "A constant effort of", "(modelgen diagnose)"  # a question that the named cause answers
    for folder, there in (("what was found", True), ("what was found/diagnosis", False)):
        page = (bench / folder / "report.html").read_text(encoding="utf-8")
        assert [text in page for text in asked_about] == [there, there]
    sizes = []
    for folder in ("generated", "extended code"):
        header = (bench / folder / "bench" / "include" / "bench.h").read_text(encoding="utf-8")
        sizes.append(int(re.findall(r"BENCH_N_PARAMETERS\b\D*(\d+)", header)[0]))
    assert sizes[1] == sizes[0] + 1  # the offset


def test_values_that_noisy_positions_bias_are_fitted_by_instruments_before_there_is_code(bench: Path) -> None:
    """Positions with noise of 5 mrad and a wide band; the same records without it have code at once."""
    (bench / "noisy").mkdir()
    for k, name in enumerate(("one", "two")):
        table = np.loadtxt(bench / "logs of may" / f"{name}.csv", delimiter=",", skiprows=1)
        table[:, 1:3] += 5e-3 * np.random.default_rng(k).standard_normal((len(table), 2))
        path = bench / "noisy" / f"{name}.csv"
        np.savetxt(path, table, fmt="%.9g", delimiter=",", header="t,q1,q2,i1,i2", comments="")
    logs = ["--train", "noisy/one.csv", "--test", "noisy/two.csv", "--mapping", "columns.yaml"]
    run(["identify", "my arm.yaml", *logs, "--cutoff", "12", "--out", "biased"], bench)
    proposed_there = {words[0]: words for words in commands(bench / "biased" / "report.html")}
    assert "generate" not in proposed_there
    again = proposed_there["identify"]
    assert again[again.index("--method") + 1] == "iv"
    run(again, bench)
    page = bench / again[again.index("--out") + 1] / "report.html"
    assert "these are by instruments" in page.read_text(encoding="utf-8")
    assert {words[0] for words in commands(page)} >= {"generate"}


def test_a_cause_that_harms_the_test_record_is_left_out_of_what_is_proposed(bench: Path) -> None:
    """A description has the others alone; where there are none, the arm as described is fitted."""
    logs = [f"logs of may/{name}.csv" for name in ("one", "two", "test")]
    with chdir(bench):
        arm = mg.load_arms("my arm.yaml")["bench"]
        asked = {"mapping": "columns.yaml", "cutoff": 7.5, "effects": ("friction_offset",)}
        d = mg.diagnose(arm, logs[:2], logs[2], experiment=False, processes=1, **asked)
    (cause,) = d.causes
    harm = replace(cause, share=replace(cause.share, gain=-9.0, low=-12.0, high=-6.0))
    other, added = replace(harm, joint=1), d.found.added[-1]
    cases = (
        (
            "beside others",
            (cause, other),
            (*d.found.added, (added[0], 1, added[2])),
            "beside others/bench_reduced.yaml",
        ),
        ("alone", (harm,), d.found.added, "my arm.yaml"),
    )
    for folder, causes, effects, description in cases:
        found = replace(d.found, causes=causes, laws=d.found.laws * len(causes), added=effects)
        with chdir(bench):
            Diagnosis(found, d.call).write(folder, code=False)
        identify, generate = commands(bench / folder / "report.html")
        values = parsed(identify, bench)
        assert (identify[0], values["train"], values["test"]) == ("identify", logs[:2], logs[2:])
        assert (values["mapping"], values["cutoff"]) == (Path("columns.yaml"), 7.5)
        assert identify[1] == generate[1] == description
        run(identify, bench)
        run([*generate, "--out", f"{folder}/code"], bench)
        assert (bench / folder / "code" / "bench" / "include" / "bench.h").is_file()
        with chdir(bench):  # what the terminal offers last
            (step,) = replaying(found, replace(d.call, folder=Path(folder)))
        words = shlex.split(step.command)[1:]
        assert words[:2] == ["simulate", description]
        assert parsed(words, bench)["log"] == logs[2:]
        run(words, bench)
    assert not (bench / "alone" / "bench_reduced.yaml").exists()
    reduced = mg.load_arms(bench / "beside others" / "bench_reduced.yaml")["bench"]
    assert [[u.name for u in j.effects].count("friction_offset") for j in reduced.joints] == [0, 1]
    both = mg.load_arms(bench / "beside others" / "bench_extended.yaml")["bench"]
    assert [[u.name for u in j.effects].count("friction_offset") for j in both.joints] == [1, 1]
    with chdir(bench):  # of a diagnosis without harm nothing remains of the one before
        d.write("beside others", code=False)
    assert not (bench / "beside others" / "bench_reduced.yaml").exists()
    first, *_ = commands(bench / "beside others" / "report.html")
    assert first[:2] == ["generate", "beside others/bench_extended.yaml"]
    (step,) = replaying(d.found, replace(d.call, folder=Path("beside others")))
    said = unescape((bench / "beside others" / "report.html").read_text(encoding="utf-8"))
    window = step.command.partition("--window ")[2].split()[0]
    assert f"modelgen simulate --log with --window {window} takes finer steps" in said
    assert shlex.split(step.command)[1:3] == ["simulate", "beside others/bench_extended.yaml"]


def test_an_arm_without_limits_gets_those_of_its_records(bench: Path) -> None:
    """In a speed limit that is the least of the largest speeds, since one option is for all joints."""
    arm = mg.load_arms(bench / "my arm.yaml")["bench"]
    with chdir(bench):
        assert Call(arm).exciting("trajectory.csv") == ""
        words = shlex.split(Call(arm).exciting("trajectory.csv", [0.81, 0.52]))[1:]
    assert parsed(words, bench)["velocity"] == 0.52
    run(words, bench)
    assert (bench / "trajectory.csv").is_file()


def test_an_excitation_is_followed_by_another_and_by_its_records(bench: Path) -> None:
    asked = ["excite", "my arm.yaml", *SHORT["excite"], "--velocity", "0.5", "--seed", "3"]
    asked += ["--box", "elbow=:,:,-0.5:", "--out", "motions/first.csv"]
    run(asked, bench)
    page = bench / "motions" / "first.html"
    other, identify = commands(page)
    again, first = parsed(other, bench), parsed(asked, bench)
    # the same motion but for its seed
    same = {name for name in first if first[name] == again[name]}
    assert first.keys() - same == {"arm", "seed", "out", "processes"}
    assert (again["arm"], again["seed"]) == ("bench", 4)
    run(other, bench)
    assert (bench / "motions" / "first_test_set_points.csv").is_file()
    said = unescape(page.read_text(encoding="utf-8"))
    for name in ("motions/first_record.csv", "motions/first_test_record.csv"):
        assert f" {name}" in said  # what does not exist yet is named in words
        (bench / name).write_text("t,q1,q2,i1,i2\n", encoding="utf-8")
    assert parsed(identify, bench)["test"] == ["motions/first_test_record.csv"]
    # nothing follows the second motion but the parameters of both
    (last,) = commands(bench / "motions" / "first_test.html")
    assert last == identify
    said = unescape((bench / "motions" / "first_test.html").read_text(encoding="utf-8"))
    assert " as motions/first_test_record.csv: the test record, " in said
    assert " where that of the first motion is motions/first_record.csv." in said


def test_what_refine_and_calibrate_propose_runs_as_it_is_copied(tmp_path: Path) -> None:
    """For arms that modelgen ships, in a folder that has no description."""
    swing = mg.simulate(mg.load_arms()["gravity_link2"], q0="20 deg", duration=6.0, rate=200.0)
    noise = 1e-3 * np.random.default_rng(0).standard_normal((3, len(swing.t)))
    for name, e in zip(("a", "b", "c"), noise, strict=True):
        table = np.column_stack([swing.t, swing.q[:, 0] + e])
        np.savetxt(tmp_path / f"{name}.csv", table, delimiter=",", header="t,q1", comments="")
    run(["refine", "--arm", "gravity_link2", "--log", "a.csv", "--out", "one"], tmp_path)
    (generate,) = commands(tmp_path / "one" / "report.html")
    run(generate, tmp_path)
    assert (tmp_path / "generated" / "gravity_link2").is_dir()
    assert "--nominal" in generate or "--parameters" in generate  # values of the start, or tuned ones
    assert "by <code>--test</code>" in (tmp_path / "one" / "report.html").read_text(encoding="utf-8")
    run(["refine", "--arm", "gravity_link2", "--log", "a.csv", "--log", "b.csv", "--out", "two"], tmp_path)
    assert len(commands(tmp_path / "two" / "report.html")) == 1  # a release is not split in two
    three = [word for name in "abc" for word in ("--log", f"{name}.csv")]
    run(["refine", "--arm", "gravity_link2", *three, "--out", "three"], tmp_path)
    _, diagnose = commands(tmp_path / "three" / "report.html")
    asked = parsed(diagnose, tmp_path)
    assert (asked["train"], asked["test"]) == (["a.csv", "b.csv"], ["c.csv"])
    done = called(*diagnose, "--effect", "spring", "--no-experiment", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    one = diagnose[diagnose.index("--train") + 4 :]
    done = called("diagnose", "--arm", "gravity_link2", "--train", "a.csv", *one, cwd=tmp_path)
    assert done.returncode == 2
    assert "found one release to train on, expected two or more" in " ".join(done.stderr.split())

    arm, motor = mg.load_arms()["ariane4"], np.linspace(0.0, 20_000.0, 300)
    angle = lever_of(arm, 3).angle(motor) + 0.02
    table = np.column_stack([0.05 * np.arange(300), motor, angle])
    np.savetxt(tmp_path / "lever.csv", table, delimiter=",", header="t,qm3,q3", comments="")
    run(["calibrate", "lever.csv", "--arm", "ariane4", "--joint", "3", "--out", "lever"], tmp_path)
    (excite,) = commands(tmp_path / "lever" / "report.html")
    assert parsed(excite, tmp_path)["arms"] == Path("lever/ariane4_calibrated.yaml")
    run(excite, tmp_path)
    assert (tmp_path / "lever" / "trajectory_set_points.csv").is_file()


def test_options_are_spelled_as_the_command_line_reads_them() -> None:
    made = ExcitationOptions(period=12.5, rest=True, boxes=("j4=:,:,0.1:", "j2=-1:1,:,:"), processes=2)  # type: ignore[arg-type]
    words = ["excite", *words_of(made)]
    values = parsed(words, Path())
    assert (values["period"], values["rest"], values["processes"]) == (12.5, True, 2)
    assert ExcitationOptions(boxes=tuple(values["boxes"])).boxes == made.boxes
    asked = ["diagnose", "--train", "a@", "--out", "x", *words_of(DiagnosisOptions(experiment=False))]
    group: Any = get_command(app)
    context = group.context_class(group, info_name="modelgen")
    name, command, rest = group.resolve_command(context, asked)
    assert command.make_context(name, rest, parent=context).params["experiment"] is True  # the flag is given
    assert words_of(DiagnosisOptions()) == []
    assert words_of(DiagnosisOptions(thresholds={"min_gain_percent": 1.0})) == []


def test_a_description_that_no_file_has_is_to_be_written_first(tmp_path: Path) -> None:
    with chdir(tmp_path):
        arm = mg.load_arms()["ariane4"]
        assert Call(arm).description == ""
        assert Call(arm).first == ""
        made = Call(replace(arm, where=None))
        assert made.description == "arms.yaml"
        assert "arms.yaml" in made.first


@pytest.mark.parametrize(
    ("verdict", "proposes"),
    [
        ("suspected", ["excite", "my arm.yaml"]),
        ("outside_catalogue", ["excite", "my arm.yaml"]),
        ("cannot_tell", ["excite", "my arm.yaml"]),
        # For all effects, where few were asked for: what is missing may be one of the others.
        ("suspected", ["diagnose", "my arm.yaml"]),
        ("outside_catalogue", ["diagnose", "my arm.yaml"]),
    ],
)
def test_programs_and_the_terminal_get_what_the_page_proposes(
    bench: Path, verdict: str, proposes: list[str]
) -> None:
    """With the same command, which runs, in the file and in what --json prints after it was written."""
    logs = [f"logs of may/{name}.csv" for name in ("one", "two", "test")]
    with chdir(bench):
        arm = mg.load_arms("my arm.yaml")["bench"]
        asked = {"mapping": "columns.yaml", "cutoff": 7.5, "effects": ("friction_offset",)}
        d = mg.diagnose(arm, logs[:2], logs[2], experiment=False, processes=1, **asked)
        suspects = d.causes if verdict == "suspected" else ()
        found = replace(d.found, verdict=verdict, causes=(), laws=(), suspects=suspects)
        if proposes[0] == "excite":
            found = replace(found, settings={**found.settings, "asked": "all"})
        shown = Diagnosis(found, d.call)
        shown.write("not named", code=False)
        (step,) = proposed(found, shown.call)
        in_memory = shown.to_json()["next_experiment"]
    page = (bench / "not named" / "report.html").read_text(encoding="utf-8")
    (words,) = commands(bench / "not named" / "report.html")
    assert words[:2] == proposes
    assert "--effect" not in words
    said = json.loads((bench / "not named" / "diagnosis.json").read_text(encoding="utf-8"))["next_experiment"]
    assert shlex.split(said["command"])[1:] == shlex.split(step.command)[1:] == words
    assert said["do"] in unescape(page)
    assert [test["test"] in unescape(page) for test in said["tests"]] == [True] * len(suspects)
    assert in_memory == said
    run(words, bench)


@pytest.mark.slow
def test_where_nothing_is_missing_the_description_as_given_goes_on(bench: Path) -> None:
    """With the parameters from the records; the extended one, which says the same, where no file has it."""
    logs = [f"logs of may/{name}.csv" for name in ("one", "two", "test")]
    with chdir(bench):
        arm = mg.load_arms("my arm.yaml")["bench"]
        asked = {"mapping": "columns.yaml", "cutoff": 7.5, "effects": ("friction_offset",)}
        d = mg.diagnose(arm, logs[:2], logs[2], experiment=False, processes=1, **asked)
        own = {name: e for name, e in d.found.parameters.items() if name != "FO2"}
        found = replace(
            d.found,
            verdict="nothing_missing",
            causes=(),
            laws=(),
            added=(),
            after=d.found.before,
            parameters=own,
        )
        shown = Diagnosis(found, d.call)
        shown.write("complete", code=False)
        (step,) = proposed(found, shown.call)
        (unread,) = proposed(found, replace(shown.call, arm=replace(arm, where=None)))
    (words,) = commands(bench / "complete" / "report.html")
    assert words == shlex.split(step.command)[1:]
    assert words[:2] == ["generate", "my arm.yaml"]
    assert words[words.index("--parameters") + 1] == "complete/bench_parameters.yaml"
    assert shlex.split(unread.command)[2] == "complete/bench_extended.yaml"
    run([*words, "--out", "complete/code"], bench)
    assert (bench / "complete" / "code" / "bench" / "include" / "bench.h").is_file()
