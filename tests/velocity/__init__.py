"""Velocity indices of platforms against 50 digits."""
