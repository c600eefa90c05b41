"""What the simulation gets wrong, and the physical cause of it by name."""
