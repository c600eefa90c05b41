"""Static analysers find nothing in generated C but the deviations listed in docs/safety.md."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from arms_support import model
from safety.eva import written

pytestmark = pytest.mark.xdist_group("safety_static")
SETTINGS = Path(__file__).parent
# The Python that is there, not what a shim on the path looks for, file after file.
MISRA = ["--addon=misra", f"--addon-python={sys.executable}"]
ARMS = ("ariane4", "scara", "ur10e", "ariane6")


@pytest.fixture(scope="module", params=ARMS)
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(model(request.param), tmp_path_factory.mktemp(request.param) / request.param)


def sources(folder: Path) -> list[str]:
    found = sorted(str(path) for path in (folder / "src").glob("*.c"))
    assert len(found) > 15
    return found


def include(folder: Path) -> list[str]:
    return [f"-I{folder}/include", f"-I{folder}/src"]


def run(command: list[str], folder: Path | None = None) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def needs(tool: str) -> None:
    if shutil.which(tool) is None:
        pytest.skip(f"needs {tool} (Debian: {tool})")


def suppressed() -> list[str]:
    lines = (SETTINGS / "cppcheck-suppressions.txt").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def test_cppcheck_and_its_misra_rules(folder: Path) -> None:
    needs("cppcheck")
    command = ["cppcheck", "--std=c99", "--language=c", *MISRA, "--error-exitcode=1", "--quiet"]
    command += ["--enable=warning,style,performance,portability", "--template={file}:{line}: {id} {message}"]
    command += [f"--suppressions-list={SETTINGS / 'cppcheck-suppressions.txt'}"]
    # Of one arm every source but the twins for standard parameters, of the other what is special to it:
    # rows of zeros, a sliding joint.
    special = ("_regressor_packed.c", "_jacobian.c", "_motor_from_joint.c")
    files = [name for name in sources(folder) if folder.name == ARMS[0] or name.endswith(special)]
    files = [name for name in files if not name.endswith("_standard.c")]
    command += [f"-D{folder.name.upper()}_REAL=float", *include(folder), *files]
    done = run(command)
    assert done.returncode == 0, done.stderr[:3000]


def test_cppcheck_would_find_a_violation(folder: Path, tmp_path: Path) -> None:
    """The rules are switched on: a pointer made of an integer, which rule 11.4 forbids."""
    needs("cppcheck")
    seeded = tmp_path / "seeded.c"
    seeded.write_text("int f(int x);\nint f(int x) { int *p = (int *)x; return *p; }\n", encoding="utf-8")
    listed = f"--suppressions-list={SETTINGS / 'cppcheck-suppressions.txt'}"
    done = run(["cppcheck", *MISRA, "--error-exitcode=1", "--enable=style", listed, str(seeded)])
    assert done.returncode == 1
    assert "misra-c2012-11.4" in done.stderr


def test_every_deviation_has_its_reason(checkout: Path) -> None:
    text = (checkout / "docs" / "safety.md").read_text(encoding="utf-8")
    rules = [line.removeprefix("misra-c2012-") for line in suppressed() if line.startswith("misra")]
    assert rules
    assert all(re.search(rf"^\| {re.escape(rule)} ", text, re.MULTILINE) for rule in rules), rules
    settings = (SETTINGS / "clang-tidy.yaml").read_text(encoding="utf-8")
    left_out = re.findall(r"-((?:readability|bugprone)-[a-z-]+)", settings)
    assert left_out
    assert all(f"`{check}`" in text for check in left_out), left_out


@pytest.mark.parametrize("derivatives", [False, True])
def test_clang_tidy(folder: Path, *, derivatives: bool) -> None:
    """Derivatives are long programs without a branch; every other function is short as well."""
    needs("clang-tidy")
    files = [name for name in sources(folder) if ("_derivatives" in name) == derivatives]
    command = ["clang-tidy", "--quiet", f"--config-file={SETTINGS / 'clang-tidy.yaml'}"]
    command += ["--checks=-readability-function-size"] if derivatives else []
    done = run([*command, *files, "--", "-std=c99", *include(folder)])
    assert done.returncode == 0, done.stdout[:3000] + done.stderr[:1000]


@pytest.mark.parametrize("real", ["float", "double"])
def test_the_analyzer_of_gcc(folder: Path, real: str, tmp_path: Path) -> None:
    if shutil.which("gcc") is None or "analyzer" not in run(["gcc", "--help=common"]).stdout:
        pytest.skip("needs gcc 10 or later")
    flags = ["-std=c99", "-O1", "-fanalyzer", "-Werror", f"-D{folder.name.upper()}_REAL={real}"]
    done = run(["gcc", *flags, *include(folder), "-c", *sources(folder)], tmp_path)
    assert done.returncode == 0, done.stderr[:3000]
    assert len(list(tmp_path.glob("*.o"))) == len(sources(folder))
