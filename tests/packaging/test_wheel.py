"""The wheel, installed away from the checkout, generates an arm with nothing but what it carries."""

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

# One worker builds the wheel, once.
pytestmark = pytest.mark.xdist_group("wheel")

PENDULUM = """\
schema: 1
convention: khalil_kleinfinger
arms:
  pendulum:
    joints:
      - {name: j1, alpha: pi/2, d: 0.1, r: 0, drive: {type: direct, ratio: 50, torque_constant: 0.02}}
"""


@dataclass(frozen=True)
class Installation:
    """A wheel and the folder it was installed into."""

    wheel: Path
    target: Path

    def python(self, *arguments: str, cwd: Path) -> "subprocess.CompletedProcess[str]":
        """Run Python in `cwd`, which is not on its path, with the installed modelgen before any other."""
        environment = os.environ | {"PYTHONPATH": str(self.target), "NO_COLOR": "1"}
        command = [sys.executable, "-P", *arguments]
        return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def installation(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Installation:
    folder = tmp_path_factory.mktemp("wheel")
    dist, target = folder / "dist", folder / "site"
    run(
        [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(dist), str(checkout)],
        folder,
    )
    (wheel,) = dist.glob("modelgen-*.whl")
    install = ["install", "--quiet", "--no-deps", "--no-index", "--target", str(target), str(wheel)]
    run([sys.executable, "-m", "pip", *install], folder)
    return Installation(wheel, target)


@pytest.fixture(scope="module")
def generate(installation: Installation) -> Callable[..., "subprocess.CompletedProcess[str]"]:
    def call(cwd: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
        return installation.python("-m", "modelgen", "generate", *arguments, cwd=cwd)

    return call


def run(command: list[str], cwd: Path) -> None:
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def files_below(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_the_wheel_carries_the_templates_the_arms_and_the_licence(
    checkout: Path, installation: Installation
) -> None:
    templates = {f"modelgen/_templates/{name}" for name in files_below(checkout / "templates")}
    assert templates
    with zipfile.ZipFile(installation.wheel) as archive:
        names = set(archive.namelist())
        metadata = next(name for name in names if name.endswith(".dist-info/METADATA"))
        assert "License-Expression: Apache-2.0" in archive.read(metadata).decode()
    wanted = templates | {"modelgen/_arms.yaml", "modelgen/py.typed", "modelgen/_gallery.jsonl"}
    wanted |= {f"modelgen/_gallery/{name}" for name in files_below(checkout / "docs" / "gallery")}
    assert wanted <= names
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in names)
    # Nothing of the checkout but the package: no tests, no generated code at the top level.
    assert {name.split("/")[0] for name in names} == {"modelgen", metadata.split("/")[0]}


def test_the_installed_package_finds_its_own_resources(installation: Installation, tmp_path: Path) -> None:
    code = (
        "import modelgen, modelgen.resources as found;"
        "print(modelgen.__file__, found.templates_folder(), found.shipped_arms(), sep='\\n');"
        "print(*found.gallery(), sep='\\n')"
    )
    done = installation.python("-c", code, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    package = installation.target / "modelgen"
    names = ("__init__.py", "_templates", "_arms.yaml", "_gallery", "_gallery.jsonl")
    expected = [package / name for name in names]
    assert done.stdout.splitlines() == [str(path) for path in expected]


def test_the_installed_package_writes_what_the_checkout_holds(
    checkout: Path, generate: Callable[..., "subprocess.CompletedProcess[str]"], tmp_path: Path
) -> None:
    done = generate(tmp_path, "--arm", "rx90", "--out", "out")
    assert done.returncode == 0, done.stderr
    written = files_below(tmp_path / "out" / "rx90")
    assert {"include/rx90.h", "rx90_casadi.py"} <= set(written)
    assert any(name.startswith("src/") and name.endswith(".c") for name in written)
    assert written == files_below(checkout / "generated" / "rx90")


def test_the_arms_of_the_folder_come_before_the_shipped_ones(
    generate: Callable[..., "subprocess.CompletedProcess[str]"], tmp_path: Path
) -> None:
    (tmp_path / "arms.yaml").write_text(PENDULUM, encoding="utf-8")
    done = generate(tmp_path, "--out", "out")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "pendulum" / "include" / "pendulum.h").is_file()
    assert not (tmp_path / "out" / "rx90").exists()

    refused = generate(tmp_path, "--arm", "rx90", "--out", "other")
    assert refused.returncode == 2
    assert "rx90" in refused.stderr
    assert "pendulum" in refused.stderr
    assert "Traceback" not in refused.stderr
    assert not (tmp_path / "other").exists()
