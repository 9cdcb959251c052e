"""The operator's window: Qt, view-models and dumb widgets. The only place that imports PySide6 or pyqtgraph.

A process of its own (``python -m rigctl.gui``) that owns no hardware: it watches and commands a controller
over its local socket. Nothing here decides anything about safety.
"""
