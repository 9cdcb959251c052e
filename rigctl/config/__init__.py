"""Rig files and their loading: TOML -> frozen models; every error names file, key, value and remedy."""
