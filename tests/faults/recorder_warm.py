"""Loaded once by the fork server of the fault tests: the recorder and the compiled code it uses."""

from rigctl.recording.evaluation import evaluate_braking
from rigctl.recording.finaliser import warm_up

warm_up(evaluate_braking)
