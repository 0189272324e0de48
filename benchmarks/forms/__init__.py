"""Scenes by conventional, parametric and relative coordinates: operations, times of an evaluation and of a run."""
