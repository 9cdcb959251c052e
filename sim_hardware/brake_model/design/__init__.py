"""What design changes do to stability: sensitivity, variations, robustness, scatter, optimum, fit."""
