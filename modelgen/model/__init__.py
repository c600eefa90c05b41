"""The equations of motion in the expression graph."""
