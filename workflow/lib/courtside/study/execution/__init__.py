"""Execution of the study: logs, atomic files, artefacts, digests of code, resources, summary.

files: `atomic`, `atomic_folder`, `write_json`, `read_json`, `sha256`, `seen_from`
script: `run`: one job
log: `to_file` and `progress`, for scripts
artefacts: `fetch` and `unpack` pinned files
registries: `wheel` and `npm_package`, downloaded, not installed
digest: `code_digest` and `Remembered`, which rerun rules whose code changed
checksums: `Checksums` of large files, kept between runs
file_dates, machine_resources: checks before any work
summary: the text at the end of a run
verdicts: `summary`, `read`, `failed`: verdicts on takes, at the end of a run
"""
