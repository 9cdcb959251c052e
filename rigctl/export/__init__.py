"""Brakings in the formats of other programs: WAV, CSV, MATLAB. Not its job: which brakings."""
