"""From a record to filtered rows with derivatives."""
