"""Recordings of RealSense cameras: rosbag files, their text and lenses; written for tests."""
