"""Hardware abstraction: device interfaces, the registry of kinds, and the `Rig` built from a rig file."""
