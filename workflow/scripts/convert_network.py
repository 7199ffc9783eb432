"""Convert one network: TFLite -> ONNX."""

from courtside.pose.conversion import tflite_onnx
from courtside.study.execution.script import run


def main(tflite_path, onnx_path, *, outputs):
    tflite_onnx.convert(tflite_path, onnx_path, outputs=outputs)


if __name__ == "__main__":
    run(main, snakemake)
