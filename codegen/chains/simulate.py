"""Run a chain, kinematics, inverse or forward dynamics, and give the files of the run."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.chains import forward, prescribed
from codegen.chains.afloat import afloat
from codegen.chains.directions import check_springs
from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.motion import drives, function, motions
from codegen.chains.record import Record, as_csv, balance, drift, energy_drift, record
from codegen.chains.run import Progress, Run
from codegen.chains.start import start
from codegen.chains.undetermined import undetermined
from codegen.errors import Mistake, SpecificationError
from codegen.measure.threads import one_thread
from codegen.mechanics.chain.model import ROW_NAMES
from codegen.simulate.limits import limit_mistakes, run_manifest
from codegen.spec.chain import Chain
from codegen.spec.chain_motions import Independent, Table

Array = NDArray[np.float64]


MODES = ("kinematics", "inverse", "forward")
"""Motion alone; efforts and reactions of a prescribed motion; motion under forces."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How a chain is run.

    Attributes:
        mode: one of `MODES`.
        duration: s.
        outputs: number of output times after the start.
        tolerance: of the integrator, relative; absolute in rad, characteristic lengths and their rates.
    """

    mode: str
    duration: float = 1.0
    outputs: int = 200
    tolerance: float = 1e-8


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedChain:
    """The files of a run.

    Attributes:
        files: path below the folder -> content.
        words: the run in a line.
        notes: what a user should know of the run.
        failure: why it stopped before the end; empty if it did not.
        mechanism: that was run.
        record: of the run, for pictures.
    """

    files: Mapping[str, bytes]
    words: str
    notes: tuple[str, ...]
    failure: str
    mechanism: Mechanism
    record: Record


def simulated(
    chain: Chain, tables: Mapping[str, str], settings: Settings, progress: Progress = lambda _: None
) -> SimulatedChain:
    """Run a chain.

    Args:
        chain: as its file has it.
        tables: text of the tables that it names.
        settings: how.
        progress: told the time reached.

    Raises:
        SpecificationError: the chain cannot be run.
    """
    chain = afloat(chain)
    check(chain, settings)
    with one_thread():
        equations = Generated(chain, settings.mode != "kinematics")
        check_springs(chain, equations)
        ready = mechanism(chain, equations)
        began = time.perf_counter()
        done = run(ready, tables, settings, progress)
        wall_time = time.perf_counter() - began
        found = record(ready, equations, done)
        loose = undetermined(ready, equations, done.states[0]) if settings.mode != "kinematics" else ()
    numbers = summary(ready, found, done, settings) | {"undetermined": list(loose), "wall_time": wall_time}
    files = {
        "trajectory.csv": as_csv(ready, found),
        "summary.json": json.dumps(numbers, indent=1) + "\n",
        "manifest.json": run_manifest("chain", chain.name),
    }
    words = f"{settings.mode}, {found.t[-1]:g} s, {len(found.t)} outputs"
    words += f", {done.iterations} iterations of Newton's method" if chain.cuts else ""
    encoded = {path: text.encode() for path, text in files.items()}
    return SimulatedChain(encoded, words, tuple(_notes(loose)), done.failure, ready, found)


def run(mechanism: Mechanism, tables: Mapping[str, str], settings: Settings, progress: Progress) -> Run:
    """Go through the output times of a run; at least the first one is reached.

    Raises:
        SpecificationError: the chain cannot start.
    """
    times = np.linspace(0.0, settings.duration, settings.outputs + 1)
    if settings.mode == "forward":
        driven = drives(mechanism.chain, tables, settings.duration)
        q_v, qd_v = initial(mechanism, tables)
        done = forward.run(mechanism, start(mechanism, q_v), qd_v, driven, times, settings.tolerance, progress)
    else:
        given = motions(mechanism.chain, tables, settings.duration)
        first = start(mechanism, given.at(0.0)[0])
        done = prescribed.run(mechanism, given, first, times, settings.mode == "inverse", progress)
    if not done.states:
        remedy = "choose another start, other independent coordinates, or give masses"
        raise SpecificationError([Mistake("t = 0", done.failure, remedy)])
    return done


def initial(mechanism: Mechanism, tables: Mapping[str, str]) -> tuple[Array, Array]:
    """Give q_v and qd_v at t = 0 for forward dynamics: given, or those of the motion, or of the row at rest."""
    found = np.array([_initial(mechanism.chain, one, tables) for one in mechanism.chain.independents]).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def _initial(chain: Chain, independent: Independent, tables: Mapping[str, str]) -> tuple[float, float]:
    position, speed, motion = independent.position, independent.speed, independent.motion
    if position is not None and speed is not None:
        return float(position), float(speed)
    row = float(chain.links[chain.index(independent.joint)].coordinate)
    q, qd, _ = function(motion, tables)(0.0) if motion is not None else (row, 0.0, 0.0)
    return (q if position is None else float(position), qd if speed is None else float(speed))


def check(chain: Chain, settings: Settings) -> None:
    """Refuse what cannot be run, before any work is done.

    Raises:
        SpecificationError: all mistakes at once.
    """
    mistakes = [*limit_mistakes(settings.tolerance, settings.duration, settings.outputs)]
    if settings.mode != "kinematics" and not any(link.mass or any(map(any, link.inertia)) for link in chain.links):
        mistakes.append(Mistake("link", "no link has a mass", "give masses, or ask for --kinematics"))
    if settings.mode == "forward":
        for independent in chain.independents:
            is_told = independent.driven or None not in (independent.position, independent.speed)
            if isinstance(independent.motion, Table) and not is_told:
                place = f'independent coordinate "{independent.joint}"'
                mistakes.append(Mistake(place, "its start is not told by a table", "give position and speed"))
    if mistakes:
        raise SpecificationError(mistakes)


def summary(mechanism: Mechanism, found: Record, done: Run, settings: Settings) -> dict[str, Any]:
    """Tell a run in numbers."""
    chain, part = mechanism.chain, mechanism.part
    numbers: dict[str, Any] = {
        "chain": chain.name,
        "mode": settings.mode,
        "completed": not done.failure,
        "stopped": done.failure or None,
        "time_reached": float(found.t[-1]),
        "tolerance": settings.tolerance if settings.mode == "forward" else None,
        "coordinates": len(chain.links),
        "independent": [chain.links[k].name for k in part.v],
        "rows": 6 * len(chain.cuts),
        "binding_rows": len(part.rows),
        "dropped_rows": dropped_rows(mechanism),
        "rank": len(part.w) if chain.cuts else 0,
        "dof": sum(not one.driven for one in chain.independents),
        "characteristic_length": mechanism.length,
        "iterations": done.iterations,
        "events": done.events,
        "steps": done.steps,
        "evaluations": done.evaluations,
        "constraint_drift": drift(chain, found),
        "energy_drift": energy_drift(found, done),
        "exchanges": done.exchanges,
        "least_singular_value": float(np.min(found.least)),
    }
    if found.tau is not None:
        numbers["joint_balance"] = balance(mechanism, found)
    return numbers


def dropped_rows(mechanism: Mechanism) -> list[dict[str, str]]:
    """Rows of the cuts that no coordinate moves, as ``summary.json`` has them."""
    kept = set(mechanism.part.rows.tolist())
    names = [(cut.name, name) for cut in mechanism.chain.cuts for name in ROW_NAMES]
    return [{"joint": cut, "row": name} for row, (cut, name) in enumerate(names) if row not in kept]


def _notes(loose: tuple[str, ...]) -> Iterator[str]:
    if loose:
        yield f"{len(loose)} components of reactions are not determined: summary.json names them under undetermined"
