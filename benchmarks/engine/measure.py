"""What is measured of the engine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from benchmarks.engine.mechanism import FORMS, engine, engine_with_less, seconds
from codegen.dynamics.jacobian import SECOND
from codegen.measure.constraints import Array
from codegen.scenes.motion_record import record
from codegen.scenes.run import Settings, run
from tests.simulate.engine import Motion, truth

PISTON = 2
DURATION = 2.0
"""s, of the comparison with the truth."""

TOLERANCES = tuple(10.0**-k for k in range(3, 11))
PRINTED = {1: (0.09, 0.09), 5: (0.42, 0.46), 20: (1.70, 1.94)}
"""Table 8 of S1: sets -> s, conventional and parametric."""

LEFT_OUT: dict[str, tuple[str, ...]] = {
    "nothing": (),
    **{name: (name,) for name in SECOND},
    "all of these": SECOND,
}


def piston(duration: float = 1.0, tolerance: float = 1e-8) -> dict[str, Array]:
    """Time, velocity and acceleration of the piston along the cylinder in both forms and of the truth."""
    settings = Settings(duration=duration, outputs=1000, tolerance=tolerance)
    columns: dict[str, Array] = {}
    for form in FORMS:
        found = record(engine(form), run(engine(form), settings)).trajectory
        columns |= {"t": found.t, f"{form} v": found.v[:, PISTON, 0], f"{form} a": found.a[:, PISTON, 0]}
    true = truth(columns["t"])
    return columns | {"truth v": true.v[:, PISTON, 0], "truth a": true.a[:, PISTON, 0]}


def differences(columns: dict[str, Array]) -> dict[str, dict[str, float]]:
    """Largest difference of velocity and acceleration, over the range of the truth."""
    pairs = {
        "conventional - parametric": FORMS,
        "conventional - truth": ("conventional", "truth"),
        "parametric - truth": ("parametric", "truth"),
    }
    return {
        words: {
            part: float(np.max(np.abs(columns[f"{one} {part}"] - columns[f"{two} {part}"])))
            / float(np.ptp(columns[f"truth {part}"]))
            for part in "va"
        }
        for words, (one, two) in pairs.items()
    }


def work_precision(rounds: int, tolerances: Sequence[float] = TOLERANCES) -> list[dict[str, Any]]:
    """Largest error of positions, velocities and accelerations over 2 s, and processor time, for each tolerance."""
    how = [
        (form, Settings(duration=DURATION, outputs=200, tolerance=tolerance))
        for tolerance in tolerances
        for form in FORMS
    ]
    times = seconds([(engine(form), settings) for form, settings in how], rounds)
    true = truth(np.linspace(0.0, DURATION, 201))
    return [
        {"form": form, "tolerance": settings.tolerance, "seconds": taken, **_errors(form, settings, true)}
        for (form, settings), taken in zip(how, times, strict=True)
    ]


def _errors(form: str, settings: Settings, true: Motion) -> dict[str, Any]:
    done = run(engine(form), settings)
    told = record(engine(form), done)
    found = told.trajectory
    if done.failure:
        return {"failure": done.failure}
    return {
        "position": float(np.max(np.abs(found.r[..., :2] - true.r))),
        "velocity": float(np.max(np.abs(found.v[..., :2] - true.v))),
        "acceleration": float(np.max(np.abs(found.a[..., :2] - true.a))),
        "drift": float(np.max(told.drift)),
        "steps": done.statistics.steps,
    }


def without_terms(rounds: int, tolerance: float = 1e-8) -> list[dict[str, Any]]:
    """What it costs to leave terms out of the Jacobian: counters of the integrator, and processor time."""
    settings = Settings(duration=DURATION, outputs=200, tolerance=tolerance)
    how = [(form, words, engine_with_less(form, names)) for form in FORMS for words, names in LEFT_OUT.items()]
    times = seconds([(ready, settings) for _, _, ready in how], rounds)
    return [
        {
            "form": form,
            "left_out": words,
            "seconds": taken,
            "time_reached": float((done := run(ready, settings)).t[-1]),
            **asdict(done.statistics),
        }
        for (form, words, ready), taken in zip(how, times, strict=True)
    ]


def by_size(sizes: Sequence[int], rounds: int, tolerance: float = 1e-6) -> list[dict[str, Any]]:
    """Processor time of 1 s for a number of engines in both forms."""
    settings = Settings(duration=1.0, outputs=1, tolerance=tolerance)
    how = [(sets, form) for sets in sizes for form in FORMS]
    times = dict(zip(how, seconds([(engine(form, sets), settings) for sets, form in how], rounds), strict=True))
    counts = {(sets, form): run(engine(form, sets), settings).statistics for sets, form in how}
    return [
        {
            "sets": sets,
            **{form: times[sets, form] for form in FORMS},
            "ratio": times[sets, "parametric"] / times[sets, "conventional"],
            "printed": PRINTED.get(sets),
            "counts": {form: asdict(counts[sets, form]) for form in FORMS},
        }
        for sets in sizes
    ]
