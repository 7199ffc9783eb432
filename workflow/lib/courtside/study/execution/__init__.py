"""Running the study: logs, whole files, artefacts, digests of code, resources, the last words."""
