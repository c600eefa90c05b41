"""The next experiment: what would tell rivals apart, within the arm's limits."""
