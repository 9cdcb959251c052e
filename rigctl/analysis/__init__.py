"""Analysis of a campaign: table of brakings and events, statistics, figures, report.

Job: read the finished braking files of a campaign and say what they mean.
NOT its job: evaluating a single braking (rigctl.signals), writing braking files (rigctl.recording).
"""
