"""Arms of any size for the measurements of growth, variants, and the page."""

import json
import shutil
from pathlib import Path

import pytest
from peers import cost, growing, pages, pages_scale, quoted, tables
from peers.arms import links_alone, subject_of
from peers.variants import SHIPPED, VARIANTS
from peers.variants_c import calls, inlined

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
DOCS = BENCHMARKS.parent / "docs"
needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")


def test_trees_have_the_shape_that_they_are_named_after() -> None:
    chain = growing.arm("chain", 50)
    assert [joint.antecedent for joint in chain.joints] == [None, *range(49)]
    binary = growing.arm("binary", 30)
    carried = [joint.antecedent for joint in binary.joints]
    assert max(carried.count(i) for i in range(30)) == 2
    limbs = growing.arm("limbs", 31)
    assert [joint.antecedent for joint in limbs.joints].count(0) == 5
    assert [joint.antecedent for joint in limbs.joints][1:8] == [0, 1, 2, 3, 4, 5, 0]
    with pytest.raises(ValueError, match="unknown shape 'star'"):
        growing.arm("star", 3)


def test_a_longer_chain_takes_more_operations_of_the_order_of_its_mass_matrix() -> None:
    def operations(joints: int) -> int:
        model = links_alone(subject_of(growing.arm("chain", joints), samples=1).arm)
        return sum(next(f for f in model.functions if f.name == "mass_matrix").operations.values())

    few, many = operations(6), operations(12)
    assert 2 * few < many < 8 * few  # n^2 elements, n^3 at most


@needs_gcc
def test_a_step_over_the_limit_is_left_out_and_a_wrong_one_reported(tmp_path: Path) -> None:
    assert cost.limited(["sh", "-c", "while :; do :; done"], 1) is None
    with pytest.raises(RuntimeError):
        cost.limited(["sh", "-c", "exit 3"], 10)
    found = cost.limited(["true"], 10)
    assert found is not None
    assert found[0] < 1


def test_every_variant_changes_something_and_leaves_no_trace() -> None:
    arm = subject_of(growing.arm("chain", 4), samples=1).arm

    def programs() -> dict[str, object]:
        return {f.name: f.program.statements for f in links_alone(arm).functions}

    before = programs()
    for variant in VARIANTS:
        with variant.change():
            changed = programs()
        if variant.group == "order":
            assert changed != before, variant.text
    assert programs() == before
    assert SHIPPED.change is not VARIANTS[0].change


def test_variants_of_the_c_name_their_arm(tmp_path: Path) -> None:
    assert '#include "src/two_private.h"' in inlined("two", tmp_path).read_text(encoding="utf-8")
    units = calls("two", 3, tmp_path)
    assert len([u for u in units if "bias" in u]) == 2
    assert "double m[3][3]" in Path(units[-1]).read_text(encoding="utf-8")


def test_modelgen_takes_fewer_operations_than_the_quoted_generators() -> None:
    ours = json.loads((BENCHMARKS / "compare.json").read_text(encoding="utf-8"))["quoted"]
    assert ours == quoted.counted()  # as they are today
    for name, others in quoted.QUOTED.items():
        for figures in others.values():
            assert all(mine < theirs for mine, theirs in zip(ours[name], figures, strict=True)), name


def test_the_page_and_its_pictures_are_those_of_the_files_of_figures(tmp_path: Path) -> None:
    result = json.loads((BENCHMARKS / "compare.json").read_text(encoding="utf-8"))
    pages.write(result, BENCHMARKS, tmp_path)
    written = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()}
    assert written["benchmarks.md"] == (DOCS / "benchmarks.md").read_text(encoding="utf-8")
    assert {"benchmarks.svg", "benchmarks-costs.svg"} <= written.keys()
    for name in written:
        assert (DOCS / name).exists()
        if name.endswith(".svg"):
            assert f"({name})" in written["benchmarks.md"]


def test_a_function_that_was_left_out_is_shown_as_such() -> None:
    arm = {"modelgen": {"functions": {"regressor": {"code": 100}}}, "traced": {"functions": {}}}
    assert pages_scale._pair(arm, "regressor", "code") == "100, -"
    assert tables.operations({"operations": {}}, {}, "regressor") == ""
