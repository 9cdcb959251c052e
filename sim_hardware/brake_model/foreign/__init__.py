"""Models made elsewhere: matrices from files as a `linear.LinearModel`, and large ones reduced."""
