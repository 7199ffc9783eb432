"""Figures of devices, those of Homma 2023 among them."""
