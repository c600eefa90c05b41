"""Kept answers of other methods: runs/others/METHOD.jsonl, a line for each case."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from blind.case import Case
from blind.cases import Entry

OTHERS = Path(__file__).resolve().parents[1] / "runs" / "others"
Line = dict[str, Any]  # truth and answer of a case


def entry_of(said: Mapping[str, Any]) -> Entry:
    """The case that a kept truth belongs to."""
    return Entry(said["family"], said["seed"], said["kind"], said["size"], said["setting"])


def truth_of(case: Case) -> dict[str, Any]:
    """What the judge and the table need of a case. met: the size that it has."""
    truth = {"effect": case.truth.effect, "joints": list(case.truth.joints), "met": case.truth.size}
    return {
        "truth": truth,
        **{k: getattr(case, k) for k in ("family", "seed", "kind", "size", "setting")},
    }


def lines(name: str, folder: Path = OTHERS) -> dict[Entry, Line]:
    """Kept answers of a method."""
    path = folder / f"{name}.jsonl"
    if not path.exists():
        return {}
    found = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {entry_of(line["truth"]): line for line in found}


def keep(name: str, found: Mapping[Entry, Line], folder: Path = OTHERS) -> None:
    """Write the answers of a method, in the order of the cases' names."""
    folder.mkdir(parents=True, exist_ok=True)
    fresh = folder / f"{name}.jsonl.new"
    text = "".join(json.dumps(found[e]) + "\n" for e in sorted(found, key=lambda e: e.name))
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(folder / f"{name}.jsonl")
