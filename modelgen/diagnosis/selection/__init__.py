"""Forward selection, exchange and backward elimination of causes."""
