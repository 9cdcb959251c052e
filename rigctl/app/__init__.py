"""The application: command line, composition root, processes and their supervision."""
