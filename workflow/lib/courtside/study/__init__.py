"""The study itself: configuration, jobs and targets, execution, provenance of results.

errors: `InputError`, an error that a user can mend; `reading`, which raises it on damaged files;
    `StrPath`, the type of paths
installed: `require`: one line where packages are missing
measure_names: the names of all measures, checked before any is measured
methods: `Calibration`, `Variant` and `Fusion`, parsed from their names
paths: the name of every file
configuration: YAML files checked as a whole, `Study`, `Session` and `Take`
targets: the files that the study makes
jobs: the files and settings that belong to a job
execution: writing files, logs, digests of code, pinned artefacts, the machine
provenance: records of results, verification, comparison, bill of materials
"""
