"""Page service of the window."""
