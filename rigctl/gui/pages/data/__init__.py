"""Page data of the window."""
