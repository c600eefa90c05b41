"""Defects put into a copy of the package, for each stage of the diagnosis: its tests must see them.

    make mutations
    PYTHONPATH=tests python -m architecture.mutations [WORD ...]     those whose stage has one of the words
    PYTHONPATH=tests python -m architecture.mutations --anew         all, whatever is known of them

Each replaces a piece of one file by another that a mistake could have left there, and runs tests of that
stage. It is caught where a test fails; not where all pass, or none can be run. Exit status 1 where one is
not caught. What was caught stands in build/mutations.txt, and is not run again while package and tests are
the same: a run that was stopped goes on where it stood. To add one: a piece that stands once in its file, a
wrong one in its place, and tests that ought to see it.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LEFT_OUT = shutil.ignore_patterns(".*", "build", "generated", "__pycache__", "node_modules")
TESTS_FAILED = 1  # pytest's exit status
KNOWN = ROOT / "build" / "mutations.txt"  # a digest a line, of what was caught


@dataclass(frozen=True)
class Mutation:
    """`right` in a file of a stage becomes `wrong`. defect: what is wrong then; tests: in tests/diagnosis."""

    stage: str
    file: str
    right: str
    wrong: str
    defect: str
    tests: tuple[str, ...]

    @property
    def path(self) -> Path:
        """From the root of a checkout."""
        return Path("modelgen", "diagnosis", self.stage, self.file)


MUTATIONS = (
    Mutation(
        "equations",
        "rows.py",
        " * self.prepared.weights[:, joints]",
        "",
        "dry friction of a joint at rest reaches the rows beside",
        ("test_sticking.py::test_what_the_effort_is_while_a_joint_rests_changes_no_equation",),
    ),
    Mutation(
        "equations",
        "rows.py",
        "part.speed(prepared.dq)",
        "prepared.dq[:, [part.one]] - part.ratio * prepared.dq[:, [part.other]]",
        "a coupling turns with the sum of two speeds instead of their difference",
        ("test_coupling_rests.py::test_rows_count_where_the_coupling_turns",),
    ),
    Mutation(
        "evidence",
        "likelihood.py",
        "np.append(said.right, math.sqrt(belief.faith)) * belief.weight",
        "np.append(said.right, math.sqrt(belief.faith))",
        "what a prior tells is not weighed by its scatter",
        ("test_prior.py",),
    ),
    Mutation(
        "evidence",
        "likelihood.py",
        "float(drop - penalty)",
        "float(drop)",
        "parameters cost no evidence",
        ("test_noise.py", "test_smooth_functions.py", "test_selection.py"),
    ),
    Mutation(
        "candidates",
        "prior_odds.py",
        "charged + math.log(candidate.forms)",
        "charged - math.log(candidate.forms)",
        "an effect with many forms is the likelier for them",
        ("test_prior_odds.py",),
    ),
    Mutation(
        "validation",
        "agreement.py",
        "sum(ranks) - max(ranks)",
        "sum(ranks)",
        "estimates of parts agree with fewer degrees of freedom than are counted",
        ("test_agreement.py",),
    ),
    Mutation(
        "validation",
        "conditions.py",
        "carried = due & (gains >= ",
        "carried = due & (gains <= ",
        "a cause that carries nothing to unseen rows is taken",
        ("test_conditions.py", "test_selection.py"),
    ),
    Mutation(
        "selection",
        "compliance.py",
        "[1].gain > ",
        "[1].gain < ",
        "a gap of no width is preferred to an elastic joint",
        ("test_compliance.py", "-k", "simpler"),
    ),
    Mutation(
        "adequacy",
        "lack_of_fit.py",
        "between = sum(float(one.between.sum()) for one in self.phases)",
        "between = max(float(one.between.max()) for one in self.phases)",
        "what repeats in every period is hardly seen",
        ("test_lack_of_fit.py",),
    ),
    Mutation(
        "extended",
        "uncertainty.py",
        "own[name] > most",
        "own[name] < most",
        "what is well determined has no interval",
        ("test_uncertainty.py",),
    ),
    Mutation(
        "selection",
        "deviations.py",
        "self.back @ self.noise @ self.back.T",
        "self.back @ self.back.T",
        "intervals take coloured noise for white",
        ("test_uncertainty.py",),
    ),
    Mutation(
        "experiment",
        "discrimination.py",
        "np.log1p(ratio)",
        "ratio",
        "evidence of a proposed experiment grows with the power, not with its logarithm",
        ("test_experiment.py",),
    ),
)


def copied(folder: Path) -> None:
    """The checkout into a folder; generated code, which no mutation changes, as a link."""
    shutil.copytree(ROOT, folder, ignore=LEFT_OUT, dirs_exist_ok=True)
    (folder / "generated").symlink_to(ROOT / "generated")


def tested(folder: Path, tests: Sequence[str]) -> int:
    """Exit status of pytest in a checkout, ended by the first failure."""
    given = [
        test if test.startswith("-") or ".py" not in test else f"tests/diagnosis/{test}" for test in tests
    ]
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *given]
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False).returncode


def caught(mutation: Mutation, folder: Path) -> bool:
    """Whether a test sees the defect in a copy of the checkout, which is put right again."""
    path = folder / mutation.path
    text = path.read_text(encoding="utf-8")
    if text.count(mutation.right) != 1:
        raise SystemExit(
            f"{mutation.path}: found {mutation.right!r} {text.count(mutation.right)} times, expected once"
        )
    path.write_text(text.replace(mutation.right, mutation.wrong), encoding="utf-8")
    try:
        return tested(folder, mutation.tests) == TESTS_FAILED
    finally:
        path.write_text(text, encoding="utf-8")


def digest(mutation: Mutation, root: Path = ROOT) -> str:
    """Digest of the mutation with the package and the tests that it is tried on."""
    found = hashlib.sha256(repr(mutation).encode())
    for part in ("modelgen", "tests"):
        for path in sorted((root / part).rglob("*.py")):
            found.update(path.relative_to(root).as_posix().encode())
            found.update(path.read_bytes())
    return found.hexdigest()


def main() -> int:
    """Print a line for each. Exit status 1 where one is not caught."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("word", nargs="*", help="stages, by default all")
    parser.add_argument("--anew", action="store_true", help="also what is known to be caught")
    given = parser.parse_args()
    words: list[str] = given.word
    chosen = [m for m in MUTATIONS if not words or any(word in m.stage for word in words)]
    known = set() if given.anew or not KNOWN.exists() else set(KNOWN.read_text(encoding="utf-8").split())
    missed = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "checkout"
        copied(folder)
        KNOWN.parent.mkdir(exist_ok=True)
        for mutation in chosen:
            name = digest(mutation)
            seen = name in known or caught(mutation, folder)
            if seen and name not in known:
                with KNOWN.open("a", encoding="utf-8") as file:
                    file.write(f"{name}\n")
            missed += not seen
            print(f"{'caught' if seen else 'MISSED':7s} {mutation.stage:11s} {mutation.defect}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} caught")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
