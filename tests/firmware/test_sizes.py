"""Float code on a Cortex-M4F: nothing double, no allocation, no output; sizes that do not grow unseen."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import size
from arms_support import ARMS, model
from firmware.build import Object, compile_arm, read_object, write, zig_program
from firmware.machine import Machine
from firmware.sizes import Size, compiler, grown
from firmware.targets import M4F
from firmware_support import measured

from modelgen.generation.sizes import code_digest, size_rows

# What the compilers' run-time libraries do for them; the square root is one instruction.
ALLOWED = {"acosf", "memset"}
FORBIDDEN = re.compile(
    r"__aeabi_(d(add|sub|rsub|mul|div|cmp\w*|2\w+)|\w+2d)|_*(malloc|calloc|realloc|free)(_r)?|\w*printf|puts|putchar"
)
GCC = pytest.mark.skipif(
    shutil.which(M4F.gcc) is None, reason=f"{M4F.gcc} not installed (.ci/run installs it)"
)
TOOLS = [pytest.param("gcc", marks=GCC), "zig"]
# Without gcc every arm is compiled by zig, else those whose functions also run on targets.
BY_ZIG = ("ariane4", "ariane6", "ur10e", "yaw3pitch") if shutil.which(M4F.gcc) else tuple(ARMS)
COMPILED = [pytest.param(name, "gcc", marks=[GCC, pytest.mark.xdist_group(name)]) for name in ARMS]
COMPILED += [pytest.param(name, "zig", marks=pytest.mark.xdist_group(name)) for name in BY_ZIG]
# Instructions and bytes in flash to stay below: inverse dynamics, mass matrix, forward dynamics, regressor.
BOUNDS = {
    "inverse_dynamics_identified": 714,
    "mass_matrix_identified": 472,
    "forward_dynamics_identified": 888,
    "regressor": 754,
}
FLASH_BOUND = 7172


def undefined(folder: Path, name: str) -> set[str]:
    """Symbols that the objects of an arm need from elsewhere."""
    objects = [read_object(path) for path in folder.glob("*.o") if path.stem != "library"]
    assert objects
    return {s for o in objects for s in o.undefined} - {f"{name}_sincos"}


@pytest.mark.parametrize(("name", "tool"), COMPILED)
def test_float_code_needs_nothing_double_no_memory_and_no_output(
    tmp_path_factory: pytest.TempPathFactory, name: str, tool: str
) -> None:
    needed = undefined(measured(name, tool, tmp_path_factory)[1] / "objects", name)
    assert not [symbol for symbol in needed if FORBIDDEN.fullmatch(symbol)]
    assert needed <= ALLOWED


SEEDED = {
    "__aeabi_dmul": "float seeded(float x) { return (float)((double)x * (double)x * (double)x); }",
    "__aeabi_f2d": "double seeded(float x) { return (double)x; }",
    "malloc": "#include <stdlib.h>\nvoid *seeded(void) { return malloc(4); }",
    "printf": '#include <stdio.h>\nvoid seeded(int x) { printf("%d", x); }',
}


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("symbol", SEEDED)
def test_a_seeded_fault_is_found(tmp_path: Path, symbol: str, tool: str) -> None:
    source = tmp_path / "src" / "seeded.c"
    source.parent.mkdir()
    (tmp_path / "include").mkdir()
    prototype = SEEDED[symbol].split("\n")[-1].split("{")[0]
    source.write_text(SEEDED[symbol].replace(prototype, f"{prototype};\n{prototype}", 1))
    objects = compile_seeded(tool, tmp_path)
    needed = {s for o in objects for s in o.undefined}
    assert symbol in needed
    assert FORBIDDEN.fullmatch(symbol)


def compile_seeded(tool: str, folder: Path) -> list[Object]:
    if tool == "gcc":
        return compile_arm(M4F, "seeded", folder, folder / "objects")
    with pytest.raises(RuntimeError, match="undefined symbol"):
        zig_program(M4F, "seeded", folder, folder / "objects")
    return [read_object(folder / "objects" / "code.o")]


@pytest.mark.parametrize("symbol", ["__aeabi_idiv", "memset", "acosf", "sqrtf", "__aeabi_fadd"])
def test_what_is_no_fault_is_not_taken_for_one(symbol: str) -> None:
    assert not FORBIDDEN.fullmatch(symbol)


@pytest.mark.parametrize(("name", "tool"), COMPILED)
def test_no_function_has_grown_by_more_than_three_percent(
    tmp_path_factory: pytest.TempPathFactory, name: str, tool: str
) -> None:
    known = size.accepted()
    if compiler(tool) not in known:
        pytest.skip(f"sizes.json holds the figures of {' and '.join(known)}, not of {compiler(tool)}")
    sizes, _ = measured(name, tool, tmp_path_factory)
    before = known[compiler(tool)].get(name, {})
    assert set(before) == set(sizes), "python benchmarks/size.py --accept"
    lines = grown(before, sizes)
    assert not lines, "accept with python benchmarks/size.py --accept:\n" + "\n".join(lines)


@pytest.mark.parametrize("name", ARMS)
def test_the_accepted_figures_are_those_of_this_code(name: str) -> None:
    """Else the README of the arm shows none: python benchmarks/size.py --accept, then generate."""
    assert size.accepted_code()[name] == code_digest(model(name))
    rows = size_rows(model(name))
    assert {row[0] for row in rows[1:]} == {f"`{f.name}`" for f in model(name).functions}


def test_growth_is_told_with_both_figures() -> None:
    before = {"gravity": Size(100, 40, 200), "bias": Size(100, 40, 200)}
    now = {"gravity": Size(103, 40, 207), "bias": Size(90, 44, 206), "new": Size(1, 1, 1)}
    assert grown(before, now) == [
        "gravity: instructions 200 -> 207 (+3.5%)",
        "bias: stack 40 -> 44 (+10.0%)",
    ]


def test_the_table_in_the_documentation_is_the_accepted_one() -> None:
    assert size.TABLE.read_text(encoding="utf-8") == size.document(size.accepted())
    assert size.ACCEPTED.read_text(encoding="utf-8") == size.serialised(size.accepted(), size.accepted_code())
    assert all(set(table) == set(ARMS) for table in json.loads(size.ACCEPTED.read_text()).values())


@pytest.mark.xdist_group("yaw3pitch")
@pytest.mark.parametrize("tool", TOOLS[:1])
def test_four_functions_of_a_bench_arm_stay_below_their_bounds(
    tmp_path_factory: pytest.TempPathFactory, tool: str
) -> None:
    """The most of any state with q in [-pi, pi]; the flash with what they share."""
    sizes, _ = measured("yaw3pitch", tool, tmp_path_factory)
    for name, most in BOUNDS.items():
        assert sizes[name].instructions <= most, name
    assert sum(sizes[name].flash for name in (*BOUNDS, "sincos")) <= FLASH_BOUND


def test_the_folded_parameters_of_the_bench_arm_are_all_there() -> None:
    values = size.nominal_base(model("yaw3pitch"))
    assert len(values) == len(model("yaw3pitch").grouping.base)
    assert all(abs(value) > 1e-6 for value in values.values())


LOOP = r"""
__asm__(".syntax unified\n.thumb\n.global loop_count\n.type loop_count, %function\n.thumb_func\n"
        "loop_count:\n"
        "    movs r2, #0\n"
        "1:  adds r2, #1\n"
        "    cmp.w r2, #10\n"
        "    bne 1b\n"
        "    vldr s0, [r0]\n"
        "    vadd.f32 s0, s0, s0\n"
        "    vstr s0, [r1]\n"
        "    movs r0, #5\n"
        "    bx lr\n"
        ".size loop_count, . - loop_count\n");
"""


def test_instructions_are_counted_one_by_one(tmp_path: Path) -> None:
    """One, ten times three, five: narrow and wide ones."""
    write({"src/loop_count.c": LOOP, "include/loop.h": ""}, tmp_path)
    _, program = zig_program(M4F, "loop", tmp_path, tmp_path / "objects")
    machine = Machine(program, M4F, count=True)
    status, out = machine.call("loop_count", [np.array([1.5])], [1])
    assert (status, out.tolist()) == (5, [3.0])
    assert machine.instructions == 1 + 10 * 3 + 5
    machine.call("loop_count", [np.array([1.5])], [1])
    assert machine.instructions == 2 * 36
