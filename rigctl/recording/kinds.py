"""Kinds of journal records about brakings, for whoever writes or reads them.

Job: the words, without loading HDF5. Not its job: what the records mean (`campaign`, `annotations`).
"""

from __future__ import annotations

from typing import Final

COMMITTED: Final = "BRAKING_COMMITTED"
"""A braking file is on the disk: payload index, file, sha256, status, attempt."""

ANNOTATED: Final = "BRAKING_ANNOTATED"
"""A person has judged a braking: payload index, action, value, who (see `annotations`)."""
