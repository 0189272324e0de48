"""Measurements: emitted code compiled and run on this machine."""
