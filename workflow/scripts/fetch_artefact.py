"""Fetch one pinned artefact: mirror folder or package registry -> its named members."""

from courtside.study.execution import artefacts, log


def main(external_yaml, name, member_paths, *, mirror_folder):
    artefact = artefacts.read(external_yaml)[name]
    outputs = dict(zip(artefact.members, member_paths, strict=True))
    artefacts.fetch(artefact, outputs, mirror_folder=mirror_folder)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.params.external,
        snakemake.params.artefact,
        list(snakemake.output),
        mirror_folder=snakemake.params.mirror_folder,
    )
