"""From 2D keypoints of several cameras to 3D: clocks applied, sides, fusion, shake, correction."""
