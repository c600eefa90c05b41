"""Generated C on microcontrollers: compiled for a target, run under emulation, counted.

Nothing of this is part of the installed package; tests, the table of sizes and the example share it.
"""
