"""Clicks, frames and footage of cameras."""
