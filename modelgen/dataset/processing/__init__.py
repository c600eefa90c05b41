"""Processing: a record becomes filtered rows with derivatives."""
