"""Page sequence of the window."""
