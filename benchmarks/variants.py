"""What other ways to generate or compile the same functions gain or lose, in instructions per call.

    python benchmarks/variants.py              print the tables
    python benchmarks/variants.py --accept     write benchmarks/variants.json, for the page of `make bench`
    python benchmarks/variants.py --many       with --accept or without: many states in one call alone
    python benchmarks/variants.py --counts     the same, instructions alone: times are those of the run before

The three bench arms, parameters folded in, x86-64-v3, counted by callgrind; on a Cortex-M4F where
arm-none-eabi-gcc is installed; and many states in one call, in vectors of four. Results are compared to those
of the generator as it is.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from firmware.sizes import measure
from firmware.targets import M4F
from peers import ours, pages_variants
from peers.arms import BENCH, Subject, links_alone, subject
from peers.cost import sections
from peers.measure import Call, instructions, values
from peers.variants import SHIPPED, VARIANTS, Variant
from peers.variants_c import calls, inlined, library
from peers.vectors import packed

from modelgen.functions import Model

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "variants"
_SAMPLES = 50


def counted(case: Subject, variant: Variant, reference: dict[str, Any] | None) -> dict[str, Any]:
    """Figures of one arm under one variant. Raises RuntimeError where results differ."""
    folder = WORK / case.arm.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    with variant.change():
        model = links_alone(case.arm)
    ours.write(model, folder)
    units, flags = None, list(variant.flags)
    if variant.kind == "inlined":
        units = [str(inlined(case.arm.name, folder))]
    elif variant.kind == "calls":
        units = [*calls(case.arm.name, case.joints, folder)]
    elif variant.kind == "library":
        flags += library(case.arm.name)
    built = ours.built(model, folder, flags, units)
    call = Call(built.program, folder, case)
    found = values(call)
    if reference is not None:
        for function, value in found.items():
            error = np.abs(value - reference[function]).max() / np.abs(reference[function]).max()
            if not error < 1e-9:
                raise RuntimeError(f"{case.arm.name}, {variant.text}: {function} differs by {error:.1e}")
    counts = {f: round(c, 1) for f, c in instructions(call).items() if f in ours.FUNCTIONS}
    operations = {
        f: sum(n for kind, n in count.items() if kind in ("mul", "add", "neg", "div"))
        for f, count in ours.operations(model).items()
        if f in ours.FUNCTIONS
    }
    # put together in another way, the objects hold other functions too
    code = None if units else sum(sections(path)["code"] for path in built.objects)
    result = {"instructions": counts, "operations": operations, "code": code, "values": found}
    if not variant.kind and not variant.flags and shutil.which(M4F.gcc):
        result["m4f"] = on_m4f(model, folder / "m4f")
    return result


def on_m4f(model: Model, folder: Path) -> dict[str, int]:
    """Instructions of the four functions on a Cortex-M4F in single precision, sine and cosine included."""
    names = {(f"{key}_identified" if folded else key): key for key, (_, folded) in ours.FUNCTIONS.items()}
    folder.mkdir()
    few = replace(model, functions=tuple(f for f in model.functions if f.name in names))
    sizes = measure(few, folder, "gcc")
    return {key: sizes[name].instructions for name, key in names.items()}


def main(arguments: Sequence[str]) -> int:
    """Count, print, write."""
    parser = argparse.ArgumentParser(description="Variants of the generated functions.")
    parser.add_argument("--accept", action="store_true", help="write benchmarks/variants.json")
    parser.add_argument("--many", action="store_true", help="measure many states in one call alone")
    parser.add_argument("--counts", action="store_true", help="of many states in one call the instructions")
    given = parser.parse_args(arguments)
    if missing := [tool for tool in ("gcc", "g++", "valgrind") if shutil.which(tool) is None]:
        parser.error(f"needs {missing[0]} (Debian: build-essential, valgrind)")
    cases = {name: subject(name, _SAMPLES) for name in BENCH}
    accepted = ROOT / "benchmarks" / "variants.json"
    before: dict[str, Any] = json.loads(accepted.read_text(encoding="utf-8"))
    whole: dict[str, Any] = before if given.many or given.counts else {"variants": compared(cases)}
    for name in cases:
        (WORK / name).mkdir(parents=True, exist_ok=True)
    found = {name: packed(case, WORK / name, timed=not given.counts) for name, case in cases.items()}
    whole["vectors"] = {name: before["vectors"].get(name, {}) | one for name, one in found.items()}
    print("\n".join(pages_variants.lines(whole)))
    if given.accept:
        accepted.write_text(json.dumps(whole, indent=1) + "\n", encoding="utf-8")
    return 0


def compared(cases: dict[str, Subject]) -> list[dict[str, Any]]:
    """Figures of every variant, the generator as it is first."""
    references: dict[str, Any] = {}
    result: list[dict[str, Any]] = []
    for variant in (SHIPPED, *VARIANTS):
        print(variant.text, file=sys.stderr, flush=True)
        arms = {}
        for name, case in cases.items():
            found = counted(case, variant, references.get(name))
            reference = found.pop("values")
            references.setdefault(name, reference)
            arms[name] = found
        result.append({"group": variant.group, "text": variant.text, "arms": arms})
    return result


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
