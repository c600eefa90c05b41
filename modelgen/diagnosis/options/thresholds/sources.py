"""Where thresholds come from that have no paper behind them."""

SIMULATED = "calibrated on simulated arms, of other seeds than those of diagnosis.md"
NULLS = "calibrated on simulated arms with nothing hidden"
MEASURED = "calibrated on measured arms, see case-studies.md"
JUDGED = "chosen by judgement"
GUARD = "a guard against records that cannot answer, chosen by judgement"
DESIGN = "a choice of design"
STRANGERS = "127 causes named on logs of others: the checks took 27 of 28 false ones and no true one"
