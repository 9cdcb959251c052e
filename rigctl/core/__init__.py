"""The words of the project: units, channels, blocks, clock, errors, journal, wire.

Imports nothing of the project. Modules that need numpy (`channels`, `blocks`, `ring`) are separate from
those the watchdog process uses (`errors`, `journal`, `wire`, `registry`, `safety_link`), which need the
standard library only.
"""
