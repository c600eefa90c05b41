"""Parameters checked once, instead of in every call."""

from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, inputs
from c_support import C_COMPILERS, WARNINGS, Library, flat_c, one_source, run, shared_library, sources, write

from modelgen.functions import Function, Model, Options, build_model
from modelgen.generation.arm import print_model

ARM = "gravity_arm"
STATUS_INPUT = 4
Built = tuple[Model, Path, Library, Library]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """The model, its folder, and the library without and with the parameters taken as checked."""
    made = build_model(ARMS[ARM], Options(derivatives=False))
    folder = tmp_path_factory.mktemp("checked")
    write(print_model(made, ARMS[ARM], {}).files, folder)
    trusting = folder / "trusting.so"
    flags = [f"-D{ARM.upper()}_PARAMETERS_CHECKED", "-std=c99", "-O2", "-fPIC", "-shared", *WARNINGS]
    include = f"-I{folder}/include"
    run([C_COMPILERS[0], *flags, include, one_source(folder), "-o", str(trusting), "-lm"])
    checking = shared_library(folder, ARM, "double")
    return made, folder, Library(checking, made, "double"), Library(trusting, made, "double")


def function(made: Model, name: str) -> Function:
    return next(f for f in made.functions if f.name == name)


@pytest.mark.parametrize("suffix", ["", "_standard"])
@pytest.mark.parametrize("bad", [np.nan, np.inf, 2e9])
def test_the_check_refuses_what_every_call_refuses(suffix: str, bad: float, built: Built) -> None:
    made, _, checking, trusting = built
    gravity = function(made, f"gravity{suffix}")
    q, good = inputs(made, gravity, np.random.default_rng(1))
    wrong = good.copy()
    wrong[-1] = bad
    for library in (checking, trusting):
        check = getattr(library.library, f"{ARM}_check_parameters{suffix}")
        statuses = [check(np.ctypeslib.as_ctypes(x.astype(float))) for x in (good, wrong)]
        assert statuses == [0, STATUS_INPUT]
    assert checking.call(gravity.name, q, wrong)[0] == STATUS_INPUT
    assert trusting.call(gravity.name, q, wrong)[0] == 0  # nobody looks at them any more


def test_what_is_checked_once_gives_the_same_and_other_inputs_are_checked_still(built: Built) -> None:
    made, _, checking, trusting = built
    for f in made.functions:
        given = inputs(made, f, np.random.default_rng(3))
        status, found = trusting.call(f.name, *given)
        assert status == 0
        _, expected = checking.call(f.name, *given)
        np.testing.assert_allclose(flat_c(found), flat_c(expected), rtol=1e-12, atol=1e-12)
        given[0] = np.full_like(given[0], np.nan)
        assert trusting.call(f.name, *given)[0] == STATUS_INPUT


@pytest.mark.skipif("gcc" not in C_COMPILERS, reason="counts the calls that gcc leaves")
def test_the_check_is_not_in_the_code(built: Built) -> None:
    _, folder, _, _ = built
    (source,) = [path for path in sources(folder) if path.endswith(f"{ARM}_gravity.c")]
    sizes = []
    for flags in ([], [f"-D{ARM.upper()}_PARAMETERS_CHECKED"]):
        made = run(["gcc", "-O2", "-std=c99", *flags, f"-I{folder}/include", "-S", source, "-o", "-"])
        sizes.append(sum(line.startswith("\t") and line[1] != "." for line in made.splitlines()))
    assert sizes[1] < sizes[0]
