"""2D pose networks in onnxruntime: detection, tracking, decoding, privacy."""
