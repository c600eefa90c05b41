"""Blind benchmark of diagnoses: families of simulated arms with hidden causes, a runner and a judge."""
