"""The virtual gymnasium: halls, players and recordings with exact truth, made from a YAML file and a seed."""
