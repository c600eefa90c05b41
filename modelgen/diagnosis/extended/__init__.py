"""The model with the causes: refitted values, their uncertainty, errors on the test record."""
