"""python -m hidden.nulls [--count N] [--seed N] [--jobs N]

What complete models leave. Of the lack of fit: how far beyond one the statistic of every joint and test
goes, over how far its quantile of F does, the largest of each null by kind of test; of shapes: the largest
evidence. Sorted. Writes modelgen/diagnosis/null_distribution.py. Run from the repository with tests/ on the
path.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from textwrap import wrap

from joblib import Parallel, delayed
from numpy.random import default_rng

from hidden.blind import SMALL
from hidden.cases import RECORDS, TEST, Case, make
from modelgen.dataset import choose, prepare
from modelgen.dataset.processing.periods import period_of, rows_in, with_whole_rows
from modelgen.description import load
from modelgen.diagnosis.adequacy.lack_of_fit import ratios
from modelgen.diagnosis.adequacy.smooth_functions import SHAPE, log_evidence, smooth_functions
from modelgen.diagnosis.equations import Equations, estimated, settings_for, settled_rows, with_errors
from modelgen.diagnosis.evidence.system import System
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import records
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model
from modelgen.regression.weighted import weighted_fit

OUT = Path(__file__).parents[2] / "modelgen" / "diagnosis" / "null_distribution.py"
HEAD = '''\
"""What complete models leave: lack of fit and the evidence of shapes (delta BIC).

The largest of all joints of a null, by kind of test (lack_of_fit.py: how far beyond one a statistic goes,
over how far its quantile does), and of all shapes (shapes.py). Two to four simulated records of {count} arms
with nothing hidden (tests/hidden/nulls.py, seed {seed}), sorted. Above one where coloured residuals have
fewer degrees of freedom than were counted.
"""

# fmt: off
NULLS: dict[str, tuple[float, ...]] = {{
'''


def of_null(arm: str, seed: int, train: int) -> dict[str, float]:
    """Of one null: lack of fit by kind of test, and the evidence of a shape."""
    with tempfile.TemporaryDirectory(prefix="null-") as name:
        folder = Path(name)
        case = Case(arm, seed, train=train)
        make(case, folder)
        described = load(folder / "arms.yaml")["arm"]
        paths = [str(folder / f"{RECORDS[k]}.csv") for k in (*case.training, TEST)]
        found = records(described, paths[:-1], paths[-1:], None, USUAL.dataset)[:-1]
    lengths = [period_of(record, None) for record in found]
    chosen = with_whole_rows(choose(list(found), settings_for(found, None, USUAL)), lengths)
    model, evaluator = build_model(described), Evaluator(described)
    rows = settled_rows(
        evaluator, model, [prepare(r, chosen) for r in found], estimated(model, USUAL.equations)
    )
    periods = [rows_in(p, chosen) for p in lengths]
    bare = Equations(model, evaluator, rows, periods, USUAL)
    system = System(with_errors(bare, weighted_fit(rows, bare.columns)))
    evidence = [log_evidence(s, system).evidence for s in smooth_functions(system)]
    return {**ratios(system), SHAPE: max(evidence)}


def main() -> int:
    """Exit status 0."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(prog="hidden.nulls", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--count", type=int, default=240)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--jobs", type=int, default=-1)
    given = parser.parse_args()
    random = default_rng(given.seed)
    drawn = [
        (SMALL[int(random.integers(len(SMALL)))], int(random.integers(10**6)), int(random.integers(2, 5)))
        for _ in range(given.count)
    ]
    found = Parallel(n_jobs=given.jobs)(delayed(of_null)(*one) for one in drawn)
    text = HEAD.format(count=given.count, seed=given.seed)
    for kind in found[0]:
        values = [f"{value:.3f}" for value in sorted(ratio[kind] for ratio in found)]
        lines = wrap(", ".join(values) + ",", 100)
        text += f'    "{kind}": (\n' + "".join(f"        {line}\n" for line in lines) + "    ),\n"
    text += "}\n# fmt: on\n"
    OUT.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
