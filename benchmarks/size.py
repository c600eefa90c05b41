"""Flash, stack and instructions of every generated function on a Cortex-M4F, in single precision.

    python benchmarks/size.py [ARM ...]       print the table, and what has grown since it was accepted
    python benchmarks/size.py --accept        accept: write benchmarks/sizes.json and docs/sizes.md

Uses arm-none-eabi-gcc where it is installed, and the Python package ziglang. Exit status 1 where a figure
has grown by more than 3 %.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from firmware.sizes import Size, Sizes, compiler, grown, measure
from firmware.targets import M4F, python_tools_missing
from peers.arms import described

from modelgen.description.objects import Arm
from modelgen.functions import Model, Options, build_model, nominal_base
from modelgen.generation.sizes import code_digest

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "benchmarks" / "sizes.json"
TABLE = ROOT / "docs" / "sizes.md"
# Arms whose nominal parameters are folded in besides.
FOLDED = ("ariane4", "yaw3pitch")

Table = Mapping[str, Sizes]  # by arm


def sized_model(arm: Arm) -> Model:
    """The model whose functions are measured."""
    model = build_model(arm)
    if arm.name not in FOLDED:
        return model
    return build_model(arm, Options(identified=nominal_base(model)))


def accepted_code() -> dict[str, str]:
    """Digests of the code whose figures were accepted, by arm."""
    code: dict[str, str] = json.loads(ACCEPTED.read_text(encoding="utf-8"))["code"]
    return code


def accepted() -> dict[str, dict[str, dict[str, Size]]]:
    """The figures that were accepted, by compiler, arm and function."""
    read = json.loads(ACCEPTED.read_text(encoding="utf-8"))
    read.pop("code")
    return {
        tool: {arm: {name: Size(**size) for name, size in sizes.items()} for arm, sizes in table.items()}
        for tool, table in read.items()
    }


def document(tables: Mapping[str, Table]) -> str:
    """docs/sizes.md."""
    lines = [
        "# Sizes on a Cortex-M4F",
        "",
        "*How much flash, stack and time does a function take on a microcontroller?*",
        "",
        "Written by `python benchmarks/size.py --accept`; [On a microcontroller](firmware.md#sizes) says "
        "what the figures mean. Single precision, [its flags](firmware.md#flags). Flash and stack in "
        "bytes; `_identified`: parameters folded in.",
    ]
    first, *others = tables
    for arm, sizes in tables[first].items():
        lines += [
            "",
            f"## {arm}",
            "",
            f"{first}; in brackets {', '.join(others)}." if others else f"{first}.",
        ]
        lines += ["", "| function | flash | stack | instructions |", "|---|---:|---:|---:|"]
        for name, size in sizes.items():
            rest = [tables[tool][arm][name] for tool in others if name in tables[tool].get(arm, {})]
            flash = "".join(f" ({r.flash})" for r in rest)
            instructions = "".join(f" ({r.instructions})" for r in rest) if size.instructions else ""
            stack = "" if size.stack is None else size.stack
            lines.append(
                f"| `{name}` | {size.flash}{flash} | {stack} | {size.instructions or ''}{instructions} |"
            )
    return "\n".join(lines) + "\n"


def serialised(tables: Mapping[str, Table], code: Mapping[str, str]) -> str:
    """benchmarks/sizes.json: one line for each function. `code`: digests of what was measured, by arm."""
    digests = [f"    {json.dumps(arm)}: {json.dumps(digest)}" for arm, digest in code.items()]
    parts = ['  "code": {\n' + ",\n".join(digests) + "\n  }"]
    for tool, table in tables.items():
        of_arms = []
        for arm, sizes in table.items():
            rows = [f"      {json.dumps(name)}: {json.dumps(asdict(size))}" for name, size in sizes.items()]
            of_arms.append(f"    {json.dumps(arm)}: {{\n" + ",\n".join(rows) + "\n    }")
        parts.append(f"  {json.dumps(tool)}: {{\n" + ",\n".join(of_arms) + "\n  }")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def tools() -> list[str]:
    """The compilers at hand."""
    if missing := python_tools_missing():
        raise SystemExit(f"size.py needs the Python package {missing}: pip install -e '.[test]'")
    return ["gcc", "zig"] if shutil.which(M4F.gcc) else ["zig"]


def main(arguments: Sequence[str]) -> int:
    """Measure, print, compare or accept."""
    parser = argparse.ArgumentParser(description="Sizes of the generated functions on a Cortex-M4F.")
    parser.add_argument("arm", nargs="*", help="arms, by default every one")
    parser.add_argument("--accept", action="store_true", help="write the tables")
    given = parser.parse_args(arguments)
    known = described()
    if unknown := [name for name in given.arm if name not in known]:
        parser.error(f"unknown arm {unknown[0]!r}, expected one of {', '.join(known)}")
    if given.accept and given.arm:
        parser.error("--accept measures every arm")
    measured: dict[str, dict[str, dict[str, Size]]] = {compiler(tool): {} for tool in tools()}
    code: dict[str, str] = {}
    for name in given.arm or known:
        model = sized_model(known[name])
        code[name] = code_digest(model)
        for tool in tools():
            with tempfile.TemporaryDirectory() as folder:
                measured[compiler(tool)][name] = measure(model, Path(folder), tool)
    if given.accept:
        ACCEPTED.write_text(serialised(measured, code), encoding="utf-8")
        TABLE.write_text(document(measured), encoding="utf-8")
    print(document(measured))
    before = accepted() if ACCEPTED.exists() else {}
    lines = [
        f"{tool}: {arm}_{line}"
        for tool, table in measured.items()
        for arm, sizes in table.items()
        for line in grown(before.get(tool, {}).get(arm, {}), sizes)
    ]
    print("\n".join(lines), file=sys.stderr)
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
