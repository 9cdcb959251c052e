"""Widgets that edit or show one value: value(), setValue(), valueChanged."""
