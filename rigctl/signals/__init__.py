"""Signal processing on recorded channels: calibration, weighting, levels, decimation, spectra, squeal,
friction.

Job: turn sample arrays into physical numbers; every function is pure (arrays in, numbers out).
NOT its job: acquiring samples (hal), storing them (recording), statistics over a campaign (analysis).
"""
