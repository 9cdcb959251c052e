"""Drivers of cooling-air ventilators."""
