"""Motion of devices, hierarchies of joints, clocks."""
