"""Page model of the window."""
