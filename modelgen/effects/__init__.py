"""Effects: each is one definition in SymPy."""
