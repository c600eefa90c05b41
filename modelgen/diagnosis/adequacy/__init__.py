"""Is what is left explained: lack of fit, smooth functions, stand-ins, causes that cannot be told apart."""
