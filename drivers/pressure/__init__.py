"""Drivers of actuators of the brake line pressure."""
