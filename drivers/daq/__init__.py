"""Data acquisition of a real rig: `acquisition.LiveAcquisition`, its sources, and their clocks."""
