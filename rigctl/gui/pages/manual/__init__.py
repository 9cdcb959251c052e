"""Page manual of the window."""
