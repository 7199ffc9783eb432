"""What rules hand to each other: skeletons, keypoints, tables."""
