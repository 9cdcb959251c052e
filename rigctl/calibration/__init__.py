"""Calibrations of the rig's sensors: what was measured, what follows, where it is kept, which one holds.

`record` is one calibration as data, `store` the folder of all, `torque`, `microphone` and `emissivity` turn
readings into a result with its faults. Not its job: taking samples and asking people (`rigctl.gui`), the
watchdog's sensors: the watchdog has a view and limits of its own.
"""
