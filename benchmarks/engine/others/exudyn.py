"""Exudyn: rigid bodies with Euler parameters and generic joints, the generalised alpha method with its Newton iteration."""

from __future__ import annotations

from exudyn.utilities import (
    AddSensorRecorder,  # noqa: F401 - loads what systems need
)

NAME = "Exudyn"
SETTINGS = tuple(1.0 / steps for steps in (500, 1000, 2000, 5000, 10000, 20000, 50000))
"""Steps, s."""
