"""What others would do on the cases of the blind benchmark: methods, one a module, and how they are run."""
