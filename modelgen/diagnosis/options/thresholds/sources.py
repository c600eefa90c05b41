"""Where thresholds come from that have no paper behind them."""

SIMULATED = "calibrated on simulated arms, of other seeds than those of diagnosis.md"
NULLS = "calibrated on simulated arms with nothing hidden"
MEASURED = "calibrated on measured arms, see case-studies.md"
JUDGED = "chosen by judgement"
GUARD = "a guard against records that cannot answer, chosen by judgement"
DESIGN = "a choice of design"
