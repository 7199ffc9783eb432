"""The study itself: configuration, artefacts, logs, files."""
