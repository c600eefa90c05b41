"""The CasADi module of an arm."""
