"""Programs that compute the same functions by other means, and how they are measured."""
