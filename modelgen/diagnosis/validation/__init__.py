"""The gates that a cause must pass on rows its fit has not seen."""
