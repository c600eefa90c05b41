"""Drives: each is one function q_m(q)."""
