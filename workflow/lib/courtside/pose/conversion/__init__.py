"""Networks converted from TFLite to ONNX."""
