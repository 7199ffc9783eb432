"""Check one ONNX file of the user: checksum, data inside it, outputs as declared -> a copy."""

import shutil

from courtside.pose import open_network
from courtside.pose.networks import session
from courtside.records.keypoints import skeleton as skeletons
from courtside.study.execution import files
from courtside.study.execution.script import run


def main(network_file, skeleton, onnx_path, *, part, sha256, decoder):
    session.check_file(network_file, sha256)
    if part == "detector":
        network = open_network.person_detector(network_file, **decoder)
    else:
        joints = skeletons.read(skeleton).joints
        network = open_network.landmark_network(network_file, joints, **decoder)
    open_network.try_out(network)
    with files.atomic(onnx_path) as copy:
        shutil.copyfile(network_file, copy)


if __name__ == "__main__":
    run(main, snakemake)
