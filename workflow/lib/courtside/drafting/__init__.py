"""A session's YAML file drafted from a folder of recordings."""
