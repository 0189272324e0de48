"""``summary.json`` of a run."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np

from codegen.measure.mobility_text import as_data
from codegen.scenes.generate import row_names
from codegen.scenes.motion_record import Record
from codegen.scenes.run import Prepared, Settings
from codegen.scenes.watched_run import Watched


def summary(prepared: Prepared, watched: Watched, settings: Settings, record: Record) -> dict[str, Any]:
    """Tell a run in numbers: rows, freedom, steps, drift of constraints and energy, singular configurations, time."""
    run = watched.run
    assembly = prepared.system.assembly
    names, drives = row_names(assembly), len(prepared.system.drives)
    energy = record.energy
    return {
        "scene": prepared.scene.name,
        "completed": not run.failure,
        "stopped": run.failure or None,
        "time_reached": float(run.t[-1]),
        "tolerance": settings.tolerance,
        "index": settings.index,
        "forms": {name: choice.variant.form for name, choice in prepared.judged.choices.items()},
        "rows": len(assembly.rows) + drives,
        "all_rows": assembly.all_rows + drives,
        "rank": prepared.judged.mobility.rank + drives,
        "dof": prepared.dof,
        "dropped_rows": [{"joint": names[row][0], "row": names[row][1]} for row in sorted(assembly.dropped)],
        "mobility": as_data(prepared.judged.mobility),
        **asdict(run.statistics),
        "evaluations": run.statistics.residuals,
        "initial_position_change": prepared.moved,
        "initial_velocity_change": prepared.motion.changed,
        "constraint_drift": float(np.max(record.drift)),
        "energy": float(energy[0]),
        "energy_drift": float(np.max(np.abs(energy - energy[0]))) if is_conservative(prepared) else None,
        "least_singular_value": watched.least,
        "dropped_rows_drift": watched.dropped,
        "passages": [asdict(passage) for passage in watched.passages],
        "wall_time": run.wall_time,
    }


def is_conservative(prepared: Prepared) -> bool:
    """Whether all forces have a potential, so that the energy stays."""
    scene = prepared.scene
    coordinates = [coordinate for joint in scene.joints for coordinate in joint.coordinates]
    lossy = any(c.damping or c.drive or c.limit for c in coordinates) or any(s.damping for s in scene.springs)
    return not lossy and not scene.torques


def as_json(told: dict[str, Any]) -> str:
    """Write ``summary.json``."""
    return json.dumps(told, indent=1) + "\n"
