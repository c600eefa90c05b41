"""Methods, one a module, each with its `METHOD`."""
