"""The list of mutations is that of the code as it is: see architecture/mutations.py, and `make mutations`."""

from pathlib import Path

import pytest

from architecture.mutations import MUTATIONS, Mutation

STAGES = (
    "equations",
    "evidence",
    "candidates",
    "validation",
    "selection",
    "adequacy",
    "extended",
    "experiment",
)


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda m: f"{m.stage}-{m.defect}")
def test_what_a_mutation_replaces_stands_once_in_its_file(mutation: Mutation, checkout: Path) -> None:
    assert (checkout / mutation.path).read_text(encoding="utf-8").count(mutation.right) == 1
    assert mutation.right != mutation.wrong


def test_every_stage_of_the_diagnosis_has_a_mutation() -> None:
    assert {mutation.stage for mutation in MUTATIONS} == set(STAGES)
    assert len(MUTATIONS) >= 10
