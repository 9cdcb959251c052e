"""The connection to a controller, and what the window makes of its news."""
