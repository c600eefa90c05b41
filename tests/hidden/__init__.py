"""Simulated arms with a hidden effect. Nothing here imports modelgen, and modelgen imports nothing from here.

Rigid bodies by Jacobians of the centres of mass (C, body.c), drives and effects in functional forms of
their own (drives.c), Moreau's midpoint stepping with set-valued friction (stepping.c).
"""
