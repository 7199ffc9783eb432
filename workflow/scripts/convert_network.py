"""Convert one network: TFLite -> ONNX."""

from courtside.pose.conversion import tflite_onnx
from courtside.study.execution import log


def main(tflite_path, onnx_path, *, outputs):
    tflite_onnx.convert(tflite_path, onnx_path, outputs=outputs)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(snakemake.input.tflite, snakemake.output.onnx, outputs=snakemake.params.outputs)
