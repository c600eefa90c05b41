"""Log files into columns, and columns into records."""
