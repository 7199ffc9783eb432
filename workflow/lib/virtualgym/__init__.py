"""The virtual gymnasium: halls, players, recordings with exact truth, from a YAML file and seed."""
