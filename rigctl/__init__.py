"""rigctl: runs a brake-noise test rig, real or simulated.

Kept free of imports: the watchdog process imports this package and must stay small.
"""

__version__ = "0.1.0"
