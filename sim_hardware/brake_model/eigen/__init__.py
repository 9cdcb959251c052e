"""Eigenvalues of a `linear.LinearModel`: all or in a band, tracked, on grids, their boundary, mode shapes."""
