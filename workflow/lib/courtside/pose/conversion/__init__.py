"""Networks converted from TFLite to ONNX.

tflite_onnx: `convert`: one file into the other, checked.
tflite_graph, tflite_tensors: `read`, `keep_outputs`: a TFLite network as plain records.
tflite_operators, onnx_writer: `convert_operator`: TFLite operators as nodes of the ONNX `Writer`.
"""
