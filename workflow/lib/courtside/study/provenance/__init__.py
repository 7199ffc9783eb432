"""Where a result comes from: record, verification, comparison, environment, bill of materials.

run: a run of Snakemake as plain values
provenance: `record` writes a sidecar for each result
planned: `ask` what a run would make now
advice: the command that makes a file anew
verification: `report` lists the results that are out of date
comparison: `compare` two trees of results within stated tolerances
stage_checksums: the first stage at which the results of two machines differ
environment: commit, lock, interpreter, packages
sbom: `of_study`, the bill of materials
"""
