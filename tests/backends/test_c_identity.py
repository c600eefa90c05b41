"""What the compiled code says of itself, and what its header tells a compiler."""

import ctypes
import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, model
from c_support import C_COMPILERS, run, shared_library, sources, write

from modelgen.api.generation import generate
from modelgen.backends.c.dialect import arrays
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.functions import EVALUATED, Options, build_model
from modelgen.generation.arm import print_model

pytestmark = pytest.mark.xdist_group("c_identity")

TEXT = """schema: 1
convention: khalil_kleinfinger
arms:
  bench:
    version: %s
    joints:
      - {name: j1}
"""


def bench(version: str) -> dict[str, str]:
    (arm,) = loads(TEXT % version, "arms.yaml", known_effects()).values()
    return dict(print_model(build_model(arm, EVALUATED), arm, {}).files)


def test_the_binary_says_which_model_it_is(tmp_path: Path) -> None:
    files = bench('"1.2.0-rc1"')
    write(files, tmp_path)
    library = ctypes.CDLL(str(shared_library(tmp_path, "bench", "double")))
    library.bench_model.restype = ctypes.c_char_p
    digest, version = library.bench_model().decode().split(" ")
    assert digest == json.loads(files["manifest.json"])["description_sha256"]
    assert re.fullmatch("[0-9a-f]{64}", digest)
    assert version == "1.2.0-rc1"
    assert json.loads(files["library.json"])["version"] == "1.2.0"


def test_a_version_is_a_word(tmp_path: Path) -> None:
    for given in ("1.2", '"one two"', "'\"'"):
        with pytest.raises(InputError, match=r"arms.yaml:5:\d+"):
            bench(given)


def test_without_a_version_it_is_the_hash_alone() -> None:
    made = print_model(build_model(ARMS["gravity_arm"], EVALUATED), ARMS["gravity_arm"], {})
    (line,) = [x for x in made.files["include/gravity_arm.h"].splitlines() if "define GRAVITY_ARM_MODEL" in x]
    assert re.fullmatch('#define GRAVITY_ARM_MODEL "[0-9a-f]{64}"', line)


def test_every_file_states_its_licence() -> None:
    files = print_model(build_model(ARMS["gravity_arm"], EVALUATED), ARMS["gravity_arm"], {}).files
    for name, text in files.items():
        if not name.endswith(".json"):
            assert "SPDX-License-Identifier: 0BSD" in text, name


def test_lengths_in_prototypes_are_those_of_the_functions() -> None:
    made = model("ur10e")
    text = print_model(made, ARMS["ur10e"], {}).files["include/ur10e.h"]
    values = {name: int(value) for name, value in re.findall(r"#define UR10E_(N_\w+)\s+(\d+)", text)}
    for f in made.functions:
        (signature,) = re.findall(rf"ur10e_status_t ur10e_{f.name}\((.*?)\);", text, re.DOTALL)
        lengths = [
            eval(re.sub(r"UR10E_(N_\w+)", lambda m: str(values[m[1]]), x))  # noqa: S307 - a product of numbers
            for x in re.findall(r"\[(.*?)\]", signature)
        ]
        assert lengths == [*(a.size for a in f.arguments), *arrays(f).values()], f.name
    assert "const ur10e_real_t parameters[UR10E_N_PARAMETERS]" in text
    assert "ur10e_real_t input_by_q[UR10E_N_JOINTS * UR10E_N_JOINTS]" in text


@pytest.mark.skipif("gcc" not in C_COMPILERS, reason="gcc warns of it")
def test_a_compiler_warns_of_an_array_that_is_too_short(tmp_path: Path) -> None:
    write(print_model(build_model(ARMS["gravity_arm"], EVALUATED), ARMS["gravity_arm"], {}).files, tmp_path)
    program = """#include "gravity_arm.h"
int f(const double parameters[GRAVITY_ARM_N_PARAMETERS], double out[2]);
int f(const double parameters[GRAVITY_ARM_N_PARAMETERS], double out[2])
{
    const double q[%d] = {0};
    return gravity_arm_gravity(q, parameters, out);
}
"""
    found = []
    for length in (1, 2):
        (tmp_path / "short.c").write_text(program % length, encoding="utf-8")
        command = ["gcc", "-O2", "-Wall", "-c", "short.c", "-Iinclude", "-o", "short.o"]
        found.append(subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stderr)
    assert "gravity_arm_gravity" in found[0]
    assert not found[1]


CALLER = """#include "gravity_arm.h"
int {name}(const {real} q[], const {real} parameters[], {real} out[]);
int {name}(const {real} q[], const {real} parameters[], {real} out[])
{{
    return gravity_arm_gravity(q, parameters, out);
}}
"""


def compiled(folder: Path, real: str) -> Path:
    """A folder with the objects of the arm's sources and of a caller, in one precision."""
    caller = folder / f"caller_{real}.c"
    caller.write_text(CALLER.format(name=f"call_{real}", real=real), encoding="utf-8")
    flags = ["-std=c99", f"-DGRAVITY_ARM_REAL={real}", "-fPIC", f"-I{folder}/include", "-c"]
    objects = folder / real
    objects.mkdir()
    for source in [str(caller), *sources(folder)]:
        run([C_COMPILERS[0], *flags, source, "-o", str(objects / f"{Path(source).stem}.o")])
    return objects


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("precisions")
    options = Options(derivatives=False)
    write(print_model(build_model(ARMS["gravity_arm"], options), ARMS["gravity_arm"], {}).files, folder)
    return {real: compiled(folder, real) for real in ("double", "float")}


@pytest.mark.parametrize(("library", "caller"), [("double", "float"), ("float", "double")])
def test_a_caller_of_the_other_precision_does_not_link(
    library: str, caller: str, objects: dict[str, Path]
) -> None:
    own = [str(path) for path in objects[library].glob("gravity_arm_*.o")]
    for who, links in ((library, True), (caller, False)):
        command = [C_COMPILERS[0], "-shared", "-Wl,-z,defs", str(objects[who] / f"caller_{who}.o"), *own]
        out = objects[library].parent / f"{library}_{who}.so"
        done = subprocess.run([*command, "-o", str(out), "-lm"], capture_output=True, text=True, check=False)
        assert (done.returncode == 0) is links
        assert links or "undefined reference to `gravity_arm_gravity" in done.stderr


def test_a_program_holds_both_precisions(objects: dict[str, Path]) -> None:
    everything = [str(path) for folder in objects.values() for path in folder.glob("*.o")]
    out = objects["float"].parent / "both.so"
    run([C_COMPILERS[0], "-shared", "-Wl,-z,defs", *everything, "-o", str(out), "-lm"])
    library = ctypes.CDLL(str(out))
    count = len(build_model(ARMS["gravity_arm"], EVALUATED).grouping.base)
    found = []
    for real, kind in (("double", np.float64), ("float", np.float32)):
        q, parameters, inputs = np.full(2, 0.3, kind), np.full(count, 0.5, kind), np.zeros(2, kind)
        call = getattr(library, f"call_{real}")
        assert call(*(ctypes.c_void_p(x.ctypes.data) for x in (q, parameters, inputs))) == 0
        found.append(inputs)
    assert np.abs(found[0]).max() > 0.1
    np.testing.assert_allclose(found[1], found[0], rtol=1e-5)


def test_the_type_without_a_flag_is_what_was_asked_for(tmp_path: Path) -> None:
    generate(ARMS["gravity_arm"], tmp_path, Options(real="float", derivatives=False))
    folder = tmp_path / "gravity_arm"
    header = (folder / "include/gravity_arm.h").read_text(encoding="utf-8")
    assert "#define GRAVITY_ARM_REAL float" in header
    assert "real: float" in header
    assert 'set(GRAVITY_ARM_REAL "float" CACHE' in (folder / "CMakeLists.txt").read_text(encoding="utf-8")
    text = '#include "gravity_arm.h"\nint main(void) { return (int)sizeof(gravity_arm_real_t); }\n'
    (tmp_path / "main.c").write_text(text, encoding="utf-8")
    run([C_COMPILERS[0], f"-I{folder}/include", str(tmp_path / "main.c"), "-o", str(tmp_path / "a.out")])
    assert subprocess.run([str(tmp_path / "a.out")], check=False).returncode == 4
    with pytest.raises(InputError, match="--real: found 'single', expected double or float"):
        Options(real="single")
