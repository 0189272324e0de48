"""Measurements of the generated routines against other programs; nothing here is installed."""
