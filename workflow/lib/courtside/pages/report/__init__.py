"""The report: facts of the study in plain words, warnings, figures with captions."""
