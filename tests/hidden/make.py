"""python -m hidden.make --effect stribeck_friction --joint 2 --arm direct2 --strength 1.3 --seed 1 --out DIR

Run from tests/. Without --effect, nothing is hidden; a second --effect hides a second one. Writes
arms.yaml, train_a.csv, train_b.csv, test.csv, check.csv and, packed, the label.
"""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

from hidden.arms import DESIGNS
from hidden.cases import Case, Hidden, make, seal
from hidden.effects import EFFECTS
from hidden.native import PlantError


def main() -> int:
    """Exit status 0, or 2 where the arm cannot do what was asked."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(prog="hidden.make", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--arm", choices=sorted(DESIGNS), default="direct2")
    parser.add_argument("--effect", choices=sorted(EFFECTS), action="append", default=[])
    parser.add_argument("--joint", type=int, action="append", default=[], help="from 1, one for each effect")
    parser.add_argument("--strength", type=float, default=1.3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--encoder", choices=("motor", "joint", "coarse"), default="motor")
    parser.add_argument("--rate", type=float, default=500.0)
    parser.add_argument("--periods", type=int, default=3)
    parser.add_argument("--noise", type=float, default=1.0, help="0 switches the current's noise off")
    parser.add_argument("--name", default="arm", help="of the arm in arms.yaml")
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    if len(given.joint) != len(given.effect):
        parser.error("one --joint for each --effect")
    hidden = tuple(
        Hidden(effect, joint, given.strength) for effect, joint in zip(given.effect, given.joint, strict=True)
    )
    case = Case(
        given.arm, given.seed, hidden, given.encoder, given.rate, given.periods, given.noise, given.name
    )
    try:
        label = make(case, given.out)
    except PlantError as error:
        sys.stderr.write(f"error: {error}\n")
        return 2
    seal(label, given.out / "label.sealed")
    sys.stdout.write(json.dumps(asdict(label), indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
