"""The six devices of the bench's CAN bus, one module each; their manual is `sim_hardware/bench/can/README.md`."""
