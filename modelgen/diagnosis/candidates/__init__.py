"""Every effect, place and form that could be there besides, each fitted alone."""
