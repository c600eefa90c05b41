"""The command line from outside: what stands on stdout and stderr, and the exit code."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import jsonschema
import pytest
from arms_support import SHIPPED, model
from command_support import Done, called
from ruamel.yaml import YAML

import modelgen
from modelgen import __version__

LEVER = """\
schema: 1
convention: khalil_kleinfinger
arms:
  boom:
    source: "a [bold]test[/bold] of text"
    joints:
      - {name: j1, alpha: pi/2, d: 0.1, r: 0, limits: {position: [-70 deg, 40 deg]},
         drive: {type: levered, l1: 0.32, l2: 0.06, length: [0.27, 0.36], motor: [0, 20000], rev: 1,
                 offset: -60 deg, torque_constant: 1.0e-4}}
      - {name: j2, d: 0.4}
"""


def call(*arguments: str, cwd: Path, checkout: Path) -> Done:
    """In this process: with its own shipped arms, those of the checkout."""
    assert Path(modelgen.__file__).is_relative_to(checkout)
    return called(*arguments, cwd=cwd)


def outside(
    *arguments: str, cwd: Path, checkout: Path, **environment: str
) -> "subprocess.CompletedProcess[str]":
    """In a process of its own, as a shell calls it."""
    variables = {k: v for k, v in os.environ.items() if k not in ("FORCE_COLOR", "PYTHONHASHSEED")}
    variables |= {"PYTHONPATH": str(checkout), "PYTHONDONTWRITEBYTECODE": "1", **environment}
    command = [sys.executable, "-P", "-m", "modelgen", *arguments]
    return subprocess.run(command, cwd=cwd, env=variables, capture_output=True, text=True, check=False)


def content(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def refused(done: "Done | subprocess.CompletedProcess[str]") -> str:
    """The one line of a refusal."""
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    return lines[0]


def test_generate_prints_a_table_and_writes_the_arms(tmp_path: Path, checkout: Path) -> None:
    arms = "--arm", "rx90", "--arm", "gravity_arm"
    done = outside("generate", *arms, "--verbose", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 0, done.stderr
    assert sorted(p.name for p in (tmp_path / "generated").iterdir()) == ["gravity_arm", "rx90"]
    row, _ = [line for line in done.stdout.splitlines() if line.strip().startswith("rx90")]
    assert row.split()[:3] == ["rx90", "6", "78→52"]
    assert int(row.split()[-1]) == len(content(tmp_path / "generated" / "rx90"))
    cost = {
        f.name: sum(f.operations[kind] for kind in ("mul", "add", "neg")) for f in model("rx90").functions
    }
    text = " ".join(done.stdout.split())
    assert f"inverse_dynamics {cost['inverse_dynamics']}/{cost['inverse_dynamics_standard']}" in text
    assert f"jacobian {cost['jacobian']}" in text
    assert "\x1b" not in done.stdout + done.stderr
    assert done.stderr == ""
    longest = max(SHIPPED, key=len)
    short = call("generate", "--arm", "rx90", "--arm", longest, cwd=tmp_path, checkout=checkout).stdout
    assert max(map(len, short.splitlines())) <= 60
    assert [line.split()[0] for line in short.splitlines() if "→" in line][1:] == ["rx90", longest]


def test_generated_files_depend_neither_on_the_hash_seed_nor_on_processes(
    tmp_path: Path, checkout: Path
) -> None:
    arms = ["--arm", "ariane4", "--arm", "two_fingers"]
    for out, seed, jobs in (("a", "0", "1"), ("b", "1", "2"), ("c", "4242", "1")):
        done = outside(
            "generate", *arms, "--out", out, "-j", jobs, cwd=tmp_path, checkout=checkout, PYTHONHASHSEED=seed
        )
        assert done.returncode == 0, done.stderr
    first = content(tmp_path / "a")
    assert len(first) > 40
    assert content(tmp_path / "b") == first
    assert content(tmp_path / "c") == first


def test_generate_json(tmp_path: Path, checkout: Path) -> None:
    done = call("generate", "--arm", "screw_axis", "--json", cwd=tmp_path, checkout=checkout)
    (arm,) = json.loads(done.stdout)["arms"]
    assert (arm["arm"], arm["joints"], arm["standard_parameters"], arm["base_parameters"]) == (
        "screw_axis",
        1,
        13,
        3,
    )
    assert arm["files"] == sorted(content(tmp_path / "generated" / "screw_axis"))
    assert arm["functions"] == {f.name: dict(f.operations) for f in model("screw_axis").functions}


def test_check_tells_drift_from_none(tmp_path: Path, checkout: Path) -> None:
    arm = ("generate", "--arm", "gravity_arm")
    call(*arm, cwd=tmp_path, checkout=checkout)
    assert call(*arm, "--check", cwd=tmp_path, checkout=checkout).returncode == 0
    path = tmp_path / "generated" / "gravity_arm" / "src" / "gravity_arm_bias.c"
    path.write_text(path.read_text().replace("9.8", "9.9"))
    (path.parent / "extra.c").touch()
    done = call(*arm, "--check", "--json", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        "generated/gravity_arm/src/extra.c: extra",
        "generated/gravity_arm/src/gravity_arm_bias.c: changed",
        f"2 files under generated differ from what {checkout / 'arms.yaml'} describes; run modelgen generate",
    ]
    assert [d["kind"] for d in json.loads(done.stdout)["drift"]] == ["extra", "changed"]
    assert (path.parent / "extra.c").exists()


def test_check_of_a_folder_that_does_not_exist(tmp_path: Path, checkout: Path) -> None:
    done = call("generate", "--arm", "gravity_arm", "--check", "--out", "no", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 1
    assert "no/gravity_arm/manifest.json: missing" in done.stderr
    assert not (tmp_path / "no").exists()


def test_show_json_is_the_contract(tmp_path: Path, checkout: Path) -> None:
    done = call("show", "--arm", "ariane4", "--json", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    made = model("ariane4")
    assert data["arm"] == "ariane4"
    assert data["joints"] == 3
    assert data["standard_parameters"] == [p.name for p in made.standard]
    assert len(data["base_parameters"]) == 24
    for parameter in data["base_parameters"]:
        assert set(parameter) == {"name", "expression", "unit"}
    assert list(data["nominal"]) == [p["name"] for p in data["base_parameters"]]
    assert set(data["functions"]) == {f.name for f in made.functions}
    for counts in data["functions"].values():
        assert {"mul", "add", "neg", "div", "sqrt", "trig"} <= set(counts)
        assert all(isinstance(count, int) and count >= 0 for count in counts.values())


def test_show_without_drives_and_effects_leaves_the_links(tmp_path: Path, checkout: Path) -> None:
    def names(*options: str) -> list[str]:
        done = call("show", "--arm", "rx90", "--json", *options, cwd=tmp_path, checkout=checkout)
        return [p["name"] for p in json.loads(done.stdout)["base_parameters"]]

    assert len(names()) == 52
    links = names("--without", "drives,effects")
    assert len(links) == 36
    assert not [name for name in links if name.startswith(("FV", "FC", "IA"))]
    assert len(names("--gains", "row_wise")) > 52


def test_show_prints_notes_and_takes_text_as_it_is(tmp_path: Path, checkout: Path) -> None:
    (tmp_path / "my.yaml").write_text(LEVER.replace("-70 deg, 40 deg", "-29.7 deg, 67 deg"))
    done = outside("show", "my.yaml", "--arm", "boom", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 0, done.stderr
    assert "source: a [bold]test[/bold] of text" in done.stdout
    assert "note: " in done.stdout
    assert "inverse_dynamics" in done.stdout
    assert "ZZ1R" in done.stdout


def test_effects_lists_names_parameters_units_and_bounds(tmp_path: Path, checkout: Path) -> None:
    done = call("effects", "--json", cwd=tmp_path, checkout=checkout)
    effects = {effect["name"]: effect for effect in json.loads(done.stdout)}
    assert {"viscous_friction", "coulomb_friction", "friction_offset", "drive_inertia", "spring"} <= set(
        effects
    )
    for effect in effects.values():
        assert effect["text"]
        assert effect["parameters"]
        for parameter in effect["parameters"]:
            assert {"name", "unit", "text", "linear", "bounds"} <= set(parameter)
    table = call("effects", cwd=tmp_path, checkout=checkout)
    assert table.returncode == 0
    assert all(name in table.stdout for name in effects)


def test_schema_accepts_the_shipped_arms_and_refuses_a_misspelt_effect(
    tmp_path: Path, checkout: Path
) -> None:
    done = call("schema", cwd=tmp_path, checkout=checkout)
    schema = json.loads(done.stdout)
    document = YAML(typ="safe").load(checkout / "arms.yaml")
    jsonschema.validate(document, schema)
    document["arms"]["rx90"]["joints"][0]["effects"] = ["viscous_fiction"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(document, schema)


def test_init_writes_a_file_that_generates_and_is_not_overwritten(tmp_path: Path, checkout: Path) -> None:
    done = call("init", "my_arm", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "wrote arms.yaml; next: modelgen generate\n"
    written = (tmp_path / "arms.yaml").read_bytes()
    assert call("generate", cwd=tmp_path, checkout=checkout).returncode == 0
    assert (tmp_path / "generated" / "my_arm" / "include" / "my_arm.h").is_file()
    line = refused(call("init", "other", cwd=tmp_path, checkout=checkout))
    assert line == "arms.yaml exists and is left as it is; choose another file with --out"
    assert (tmp_path / "arms.yaml").read_bytes() == written
    done = call("init", "other", "--out", "other.yaml", cwd=tmp_path, checkout=checkout)
    assert done.stderr == "wrote other.yaml; next: modelgen generate other.yaml\n"


def test_init_refuses_a_name_that_is_no_identifier(tmp_path: Path, checkout: Path) -> None:
    assert "'while' is a keyword of C" in refused(call("init", "while", cwd=tmp_path, checkout=checkout))
    assert "6dof" in refused(call("init", "6dof", cwd=tmp_path, checkout=checkout))
    assert "cannot write no/such/folder.yaml" in refused(
        call("init", "arm", "--out", "no/such/folder.yaml", cwd=tmp_path, checkout=checkout)
    )
    assert not list(tmp_path.iterdir())


BAD = [
    (["--arm", "rx9"], "found no arm 'rx9', did you mean 'rx90'? (available: ariane4, "),
    (["--arm", "zzz"], "found no arm 'zzz' (available: ariane4, "),
    (["--without", "drive"], "--without: found 'drive', expected drives or effects, did you mean 'drives'?"),
    (["nofile.yaml"], "nofile.yaml: there is no such file"),
    (["bad.yaml"], "bad.yaml:8:"),
    (["--out", "bad.yaml"], "cannot write to bad.yaml: bad.yaml is a file, expected a folder"),
    (["--out", "bad.yaml/sub"], "cannot write to bad.yaml/sub: bad.yaml is a file, expected a folder"),
    (["--arm", "rx90", "--batch", "gravity,biass"], "--batch: found 'biass', did you mean 'bias'?"),
    (["--arm", "rx90", "--out", "mine"], "cannot replace mine/rx90: it was not generated (no manifest.json)"),
    (["--arm", "rx90", "--jacobian-link", "j9"], "j9"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD, ids=[" ".join(a) for a, _ in BAD])
def test_bad_input_is_one_line_and_nothing_is_written(
    tmp_path: Path, checkout: Path, arguments: list[str], message: str
) -> None:
    (tmp_path / "bad.yaml").write_text(LEVER.replace("l2: 0.06", "l3: 0.06"))
    (tmp_path / "mine" / "rx90").mkdir(parents=True)
    (tmp_path / "mine" / "rx90" / "thesis.txt").write_text("kept")
    before = content(tmp_path)
    assert message in refused(call("generate", *arguments, cwd=tmp_path, checkout=checkout))
    assert content(tmp_path) == before
    assert not (tmp_path / "generated").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["generate", "--no-such"],
        ["identify"],
        ["generate", "--gains", "guessed"],
        ["generate", "-j", "0"],
        ["nothing"],
    ],
    ids=" ".join,
)
def test_a_wrong_call_exits_with_2_and_shows_the_usage(
    tmp_path: Path, checkout: Path, arguments: list[str]
) -> None:
    done = call(*arguments, cwd=tmp_path, checkout=checkout)
    assert done.returncode == 2
    assert "Usage: modelgen" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_version_and_help(tmp_path: Path, checkout: Path) -> None:
    assert outside("--version", cwd=tmp_path, checkout=checkout).stdout == f"modelgen {__version__}\n"
    for arguments in ([], ["--help"]):
        done = call(*arguments, cwd=tmp_path, checkout=checkout)
        assert done.returncode == 0
        assert all(command in done.stdout for command in ("generate", "show", "effects", "schema", "init"))


def test_the_help_imports_neither_sympy_nor_casadi_nor_numpy(tmp_path: Path, checkout: Path) -> None:
    code = (
        "import sys, modelgen.cli; sys.argv = ['modelgen', '--version']\n"
        "try: modelgen.cli.main()\n"
        "except SystemExit: pass\n"
        "print(sorted({'sympy', 'casadi', 'numpy', 'jinja2', 'ruamel'} & set(sys.modules)))"
    )
    command = [sys.executable, "-P", "-c", code]
    environment = os.environ | {"PYTHONPATH": str(checkout)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_generating_does_not_import_casadi(tmp_path: Path, checkout: Path) -> None:
    code = (
        "import sys, modelgen.cli; sys.argv = ['modelgen', 'generate', '--arm', 'screw_axis']\n"
        "try: modelgen.cli.main()\n"
        "except SystemExit: pass\n"
        "print('casadi' in sys.modules)"
    )
    command = [sys.executable, "-P", "-c", code]
    environment = os.environ | {"PYTHONPATH": str(checkout)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "False"


def test_ctrl_c_is_one_line_and_leaves_nothing_half_written(tmp_path: Path, checkout: Path) -> None:
    variables = os.environ | {"PYTHONPATH": str(checkout), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-P", "-m", "modelgen", "generate", "-j", "1"]
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job's child ignores it
    try:
        process = subprocess.Popen(
            command, cwd=tmp_path, env=variables, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
    finally:
        signal.signal(signal.SIGINT, before)
    time.sleep(2.5)  # in the middle of generating
    process.send_signal(signal.SIGINT)
    stdout, stderr = process.communicate(timeout=60)
    assert process.returncode == 130
    assert stdout == ""
    assert stderr.splitlines() == ["interrupted; nothing is half-written"]
    assert not list(tmp_path.iterdir())


def test_a_mistake_of_ours_is_not_hidden(tmp_path: Path, checkout: Path) -> None:
    code = (
        "import sys, modelgen.cli, modelgen.effects as e; sys.argv = ['modelgen', 'effects']\n"
        "e.CATALOGUE['broken'] = None\n"
        "modelgen.cli.main()"
    )
    command = [sys.executable, "-P", "-c", code]
    environment = os.environ | {"PYTHONPATH": str(checkout)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "AttributeError" in done.stderr


def test_progress_is_for_terminals_and_goes_to_stderr(tmp_path: Path, checkout: Path) -> None:
    pty = pytest.importorskip("pty", reason="needs a pseudo-terminal")
    controller, terminal = pty.openpty()
    variables = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
    variables |= {"PYTHONPATH": str(checkout), "TERM": "xterm-256color"}
    command = [sys.executable, "-P", "-m", "modelgen", "generate", "--arm", "screw_axis", "--json"]
    done = subprocess.run(
        command, cwd=tmp_path, env=variables, stdout=subprocess.PIPE, stderr=terminal, text=True, check=True
    )
    os.close(terminal)
    shown = b""
    with contextlib.suppress(OSError):  # how a terminal without another end says that it is at its end
        while piece := os.read(controller, 65536):
            shown += piece
    os.close(controller)
    assert b"1/1" in shown
    assert json.loads(done.stdout)["arms"]


def test_every_shipped_arm_is_offered(tmp_path: Path, checkout: Path) -> None:
    line = refused(outside("show", "--arm", "?", cwd=tmp_path, checkout=checkout))
    assert line.endswith(f"(available: {', '.join(SHIPPED)})")


def test_the_arm_is_named_where_the_file_has_several(tmp_path: Path, checkout: Path) -> None:
    done = call("show", cwd=tmp_path, checkout=checkout)
    assert done.returncode == 2
    assert "found 16 arms and no --arm, expected --arm with one of ariane4, " in done.stderr
    assert done.stdout == ""


def test_the_only_arm_of_a_file_needs_no_name(tmp_path: Path, checkout: Path) -> None:
    assert call("init", "mine", cwd=tmp_path, checkout=checkout).returncode == 0
    one, other = (call("show", *more, cwd=tmp_path, checkout=checkout) for more in ([], ["--arm", "mine"]))
    assert one.returncode == 0
    assert one.stdout == other.stdout


def test_generate_says_where_it_wrote(tmp_path: Path, checkout: Path) -> None:
    one = ["generate", "--arm", "screw_axis", "--out", "code", "-j", "1"]
    both = [*one, "--arm", "gravity_arm"]
    for words, folder in ((one, "code/screw_axis"), (both, "code")):
        done = call(*words, cwd=tmp_path, checkout=checkout)
        assert done.stdout.splitlines()[-1] == f"code: {folder}"
        assert (tmp_path / folder).is_dir()
    assert "code:" not in call(*one, "--check", cwd=tmp_path, checkout=checkout).stdout


def test_show_is_short_and_has_the_tables_on_demand(tmp_path: Path, checkout: Path) -> None:
    words = ["show", "--arm", "ur10e"]
    short = call(*words, cwd=tmp_path, checkout=checkout).stdout
    long = call(*words, "--verbose", cwd=tmp_path, checkout=checkout).stdout
    assert len(short.splitlines()) <= 100
    shown = json.loads(call(*words, "--json", cwd=tmp_path, checkout=checkout).stdout)
    assert all(p["expression"].split()[0] in short for p in shown["base_parameters"])
    cost = {n: str(sum(f[k] for k in ("mul", "add", "neg"))) for n, f in shown["functions"].items()}
    rows = [line.split() for line in short.splitlines()]
    assert ["inverse_dynamics", cost["inverse_dynamics"], cost["inverse_dynamics_standard"]] in rows
    assert ["jacobian", cost["jacobian"]] in rows
    rows = [line.split() for line in long.splitlines()]
    for name, counts in shown["functions"].items():
        kinds = ("mul", "add", "neg", "div", "sqrt", "trig", "other")
        assert [name, cost[name], *(str(counts.get(kind, 0)) for kind in kinds)] in rows
    assert all(name in long for name in shown["without_effect"])
    assert long.startswith(short[: short.index("--verbose")].rstrip())
