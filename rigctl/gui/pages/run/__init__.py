"""Page run of the window."""
