"""What players do: footwork, strokes, walking, T-pose and clap."""
