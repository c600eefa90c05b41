"""Tests that share what takes long to make run in one process."""

import pytest


@pytest.mark.xdist_group("together")
def test_a_group_of_tests_has_a_process(request: pytest.FixtureRequest) -> None:
    """By the end of its name: releases of pytest and pytest-xdist that do not fit each other leave it out."""
    if not getattr(request.config.option, "loadgroup", False):
        pytest.skip("one process, or tests sent to any")
    assert request.node.nodeid.endswith("@together")
