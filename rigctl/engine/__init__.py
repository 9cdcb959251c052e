"""The sequence engine: executes a program on a rig, driven by blocks."""
