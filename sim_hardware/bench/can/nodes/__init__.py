"""The six devices of the bench's CAN bus, one module each; their manual is README.md in the folder above."""
