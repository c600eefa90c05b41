"""The laws themselves, one class each."""
