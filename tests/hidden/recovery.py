"""What is left of a case's test record where the effect is absent: what a complete model could reach."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hidden import logs
from hidden.cases import RECORDS, TEST, Bench, Case
from modelgen.dataset import choose, prepare
from modelgen.dataset.processing.periods import period_of, with_whole_rows
from modelgen.description import load
from modelgen.diagnosis.equations import estimated, settings_for, settled_rows
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import records
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model
from modelgen.functions.options import EVALUATED
from modelgen.regression.weighted import weighted_fit


def reachable(case: Case, folder: Path, cutoff: float | None = None) -> list[float]:
    """RMSE (n,) [A] on `test`, of the model fitted to the training records, all without the effect: same arm,
    motions and noise, and the filters of the diagnosis, which chose `cutoff` [Hz].
    folder: where the case was made.
    """
    bench, arm = Bench(case), load(folder / "arms.yaml")[case.name]
    paths = []
    for k in (*case.training, TEST):
        paths.append(str(folder / f"{RECORDS[k]}_without.csv"))
        logs.write(Path(paths[-1]), bench.record(k, {}))
    found = records(arm, paths[:-1], paths[-1:], None, USUAL.dataset)
    lengths = [period_of(record, None) for record in found[:-1]]
    settings = with_whole_rows(choose(found[:-1], settings_for(found, cutoff, USUAL)), lengths)
    model, evaluator = build_model(arm, EVALUATED), Evaluator(arm)
    *train, test = settled_rows(
        evaluator, model, [prepare(r, settings) for r in found], estimated(model, USUAL.equations)
    )
    theta = weighted_fit(train, [r.columns for r in train])
    left = (test.effort - test.columns @ theta) * test.gain
    n = left.shape[1]
    return [float(np.sqrt(np.mean(left[test.moving[:, j], j] ** 2))) for j in range(n)]
