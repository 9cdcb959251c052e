"""Fixtures of the manual page: a connection that keeps what was asked; live plots are left out."""

from recording_rig import real_plots, rig, still_plots

__all__ = ["real_plots", "rig", "still_plots"]
