"""2D pose networks in onnxruntime."""
