"""Drivers of real devices behind `rigctl.hal`, one folder per device role.

A driver is found by the registry (`rigctl.core.registry`) or, for third parties, by an entry point of the
group `rigctl.devices`. Vendor libraries are imported inside the driver's own module only.
"""
