"""The simulated rig behind `rigctl.hal`: a process of its own that stands for the hardware.

Kept free of imports: the watchdog process imports `safety_link` from here.
"""
