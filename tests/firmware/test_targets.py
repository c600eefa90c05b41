"""Generated code run on emulated microcontrollers gives what NumPy gives in double on the host.

Two ways: boards in QEMU, compiled by the cross compilers of the distribution; and a Cortex-M within
Python, compiled by the package ziglang, which needs nothing that pip does not install.
"""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from arms_support import model
from firmware.build import Object, compile_arm, read_object, write, zig_program
from firmware.exchange import Call, on_board, program
from firmware.machine import Machine
from firmware.states import Inputs
from firmware.targets import M4F, M7_DOUBLE, TARGETS, Target
from firmware_support import measured, sized

from modelgen.backends import NumpyFunction, Provenance, c_files
from modelgen.backends.c.dialect import arrays

TRIED = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in ("ariane4", "ariane6", "ur10e")]
INSIDE, AT_ENDS = 250, 50  # states with the levers within their strokes, and at their ends
TOLERANCE = {"float": 1e-5, "double": 1e-12}  # relative to the norm of the result
ROUNDED_ZERO = 1e-13  # relative to the largest element
ELEMENT_TOLERANCE = {"float": 5e-5, "double": 1e-12}


@cache
def cases(name: str, real: str) -> tuple[list[Call], list[np.ndarray]]:
    """Calls of every function, with inputs that the target's type can hold, and the results on the host."""
    kind = np.float32 if real == "float" else np.float64
    calls, expected = [], []
    made = model(name)
    sample = Inputs(made, 21)
    for k, f in enumerate(made.functions):
        ends = [False] * INSIDE + [True] * AT_ENDS
        samples = [[x.astype(kind).astype(float) for x in sample(f, ends=e)] for e in ends]
        columns = [np.array([given[i] for given in samples]) for i in range(len(f.arguments))]
        result = NumpyFunction(f)(*columns)
        parts = [
            np.reshape(r, (len(samples), -1)) for r in (result if isinstance(result, tuple) else (result,))
        ]
        calls += [Call(k, given) for given in samples]
        expected += list(np.concatenate(parts, axis=1))
    return calls, expected


def worst(
    name: str,
    calls: Sequence[Call],
    expected: Sequence[np.ndarray],
    found: Sequence[tuple[int, np.ndarray]],
) -> dict[str, tuple[float, float]]:
    """The largest error of each function, relative to the norm of its result and by element; statuses are ok.

    An element's error is taken relative to the root mean square of that element over all states, so that
    small elements beside large ones are looked at too; not where the element is nothing but rounding.
    """
    errors = {}
    for k, f in enumerate(model(name).functions):
        mine = [i for i, call in enumerate(calls) if call.function == k]
        assert len(mine) == INSIDE + AT_ENDS
        assert not any(found[i][0] for i in mine), f.name
        right = np.array([expected[i] for i in mine])
        difference = np.abs(np.array([found[i][1] for i in mine]) - right)
        assert np.isfinite(difference).all(), f.name
        by_norm = np.linalg.norm(difference, axis=1) / np.linalg.norm(right, axis=1)
        scale = np.sqrt(np.mean(right**2, axis=0))
        assert not difference[:, scale == 0].any(), f.name
        told = scale > ROUNDED_ZERO * scale.max()
        by_element = difference[:, told] / scale[told]
        errors[f.name] = float(by_norm.max()), float(by_element.max())
    return errors


def check(errors: dict[str, tuple[float, float]], real: str) -> None:
    for function, (by_norm, by_element) in errors.items():
        assert by_norm <= TOLERANCE[real], (function, by_norm)
        assert by_element <= ELEMENT_TOLERANCE[real], (function, by_element)


def by_gcc(
    target: Target, name: str, folder: Path, folders: pytest.TempPathFactory
) -> tuple[Path, list[Object]]:
    """The folder of an arm's sources and its objects: those of which the sizes are measured, where there are
    such.
    """
    if target is M4F and sized(name) is model(name):
        folder = measured(name, "gcc", folders)[1]
        return folder, [read_object(file) for file in sorted((folder / "objects").glob("*.o"))]
    write(c_files(model(name), Provenance("modelgen test", "0" * 64)), folder)
    return folder, compile_arm(target, name, folder, folder / "objects")


def by_zig(target: Target, name: str, folder: Path, folders: pytest.TempPathFactory) -> Path:
    """A program of an arm's functions: that of which the sizes are measured, where there is such."""
    if target is M4F and sized(name) is model(name):
        return measured(name, "zig", folders)[1] / "objects" / "program.elf"
    write(c_files(model(name), Provenance("modelgen test", "0" * 64)), folder)
    return zig_program(target, name, folder, folder / "objects")[1]


@pytest.mark.parametrize("name", TRIED)
@pytest.mark.parametrize("target", TARGETS, ids=lambda t: f"qemu-{t.name}-{t.real}")
def test_a_board_in_qemu_computes_what_the_host_does(
    target: Target, name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    if target.missing:
        pytest.skip(f"{target.missing} not installed (.ci/run installs it)")
    folder, objects = by_gcc(target, name, tmp_path, tmp_path_factory)
    binary = program(target, model(name), folder, objects, tmp_path / "program")
    calls, expected = cases(name, target.real)
    errors = worst(name, calls, expected, on_board(target, model(name), binary, calls, tmp_path / "run"))
    check(errors, target.real)


@pytest.mark.parametrize("name", TRIED)
@pytest.mark.parametrize("target", [M4F, M7_DOUBLE], ids=lambda t: f"python-{t.name}-{t.real}")
def test_a_processor_within_python_computes_what_the_host_does(
    target: Target, name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    binary = by_zig(target, name, tmp_path, tmp_path_factory)
    machine = Machine(binary, target)
    calls, expected = cases(name, target.real)
    functions = model(name).functions
    found = []
    for call in calls:
        f = functions[call.function]
        found.append(machine.call(f"{name}_{f.name}", call.inputs, list(arrays(f).values())))
    errors = worst(name, calls, expected, found)
    check(errors, target.real)


@pytest.mark.parametrize("name", TRIED[:1])
def test_beyond_its_stroke_a_lever_gives_the_status_and_zeros(
    name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """On the target as on the host; and a comparison that always held would not see a wrong result."""
    machine = Machine(by_zig(M4F, name, tmp_path, tmp_path_factory), M4F)
    (f,) = [f for f in model(name).functions if f.name == "inverse_dynamics"]
    x = Inputs(model(name), 1)(f)
    _, good = machine.call(f"{name}_{f.name}", x, [3])
    assert np.linalg.norm(good) > 0
    x[0][0] = f.ranges[0].high + 0.01
    status, result = machine.call(f"{name}_{f.name}", x, [3])
    assert status == 1
    assert not result.any()
