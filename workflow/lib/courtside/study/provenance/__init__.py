"""Where a result comes from: record, verification, comparison, environment, bill of materials.

run: a run of Snakemake as plain values
provenance: `record` writes a sidecar for each result
verification: `report` says which results would differ if made now
comparison: `compare` two trees of results within stated tolerances
stage_checksums: where two machines' results part
environment: commit, lock, interpreter, packages
sbom: `of_study`, the bill of materials
"""
