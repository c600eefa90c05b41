"""Parameters from simulated motion: output-error identification."""
