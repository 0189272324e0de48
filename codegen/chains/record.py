"""A run as columns: coordinates, efforts, reactions of cuts, wrenches of joints, poses of effectors."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from codegen.chains.generated import Generated
from codegen.chains.mechanism import AXES, Mechanism
from codegen.chains.rotation import quaternion
from codegen.chains.run import Run
from codegen.spec.chain import Chain

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """A run at [k] output times.

    Attributes:
        t: [k] s.
        q: [k, n] m or rad.
        qd: [k, n].
        qdd: [k, n].
        frames: [k, nf, 3, 4] of links, C, R and E: rotation to the base's axes, origin in m.
        least: [k] smallest singular value of the dependent columns of the Jacobian, relative to the largest.
        tau: [k, n] along the coordinates in all, N or N m; None in kinematics.
        effort: [k, nv] of it, what a prescribed motion needs beside the forces of the file.
        reaction: [k, 6 nr] of the cuts on their frames R, axes of C, which are those of R.
        wrenches: [k, n, 6] of each joint on its link about the link's origin, link axes.
        kinetic: [k] energy, J.
        power: [k] of gravity, forces and efforts, W.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    frames: Array
    least: Array
    tau: Array | None = None
    effort: Array | None = None
    reaction: Array | None = None
    wrenches: Array | None = None
    kinetic: Array | None = None
    power: Array | None = None


def record(mechanism: Mechanism, equations: Generated, run: Run) -> Record:
    """Lay a run out in columns.

    Args:
        mechanism: the chain.
        equations: of the chain.
        run: of at least one state.
    """
    states, loads = run.states, [state.loads for state in run.states if state.loads is not None]
    motion = Record(
        t=np.array([state.t for state in states]),
        q=np.array([state.q for state in states]),
        qd=np.array([state.qd for state in states]),
        qdd=np.array([state.qdd for state in states]),
        frames=np.array([equations.frames(state.q) for state in states]),
        least=np.array([state.least for state in states]),
    )
    if not loads:
        return motion
    pairs = list(zip(states, loads, strict=True))
    return replace(
        motion,
        tau=np.array([one.tau for one in loads]),
        effort=np.array([one.effort for one in loads]),
        reaction=np.array([one.reaction for one in loads]),
        wrenches=np.array([equations.wrenches(s.q, s.qd, s.qdd, one.reaction, one.wrenches) for s, one in pairs]),
        kinetic=np.array([one.kinetic for one in loads]),
        power=np.array([one.power for one in loads]),
    )


def balance(mechanism: Mechanism, found: Record) -> float:
    """Give the largest ``h^T f + rotor qdd - tau`` of a joint's wrench, relative to the largest component, 1 at least.

    The wrenches come link by link from the end of the tree; that their parts along the joints are what acts there
    checks accelerations and reactions.
    """
    if found.tau is None or found.wrenches is None:
        return 0.0
    parts = np.einsum("kij,ij->ki", found.wrenches, _directions(mechanism.chain))
    parts += found.qdd * np.array([float(link.rotor) for link in mechanism.chain.links])
    return float(np.max(np.abs(parts - found.tau)) / max(1.0, float(np.max(np.abs(found.wrenches)))))


def drift(chain: Chain, found: Record) -> float:
    """Give the largest row of a cut, ``(p; 2 e)`` in m and 1, at any output; 0 without cuts."""
    first, cuts = len(chain.links), len(chain.cuts)
    C, R = found.frames[:, first : first + cuts], found.frames[:, first + cuts : first + 2 * cuts]
    p = np.einsum("kcji,kcj->kci", C[..., :3], R[..., 3] - C[..., 3])
    turned = np.einsum("kcji,kcjl->kcil", C[..., :3], R[..., :3]).reshape(-1, 3, 3)
    e = np.array([quaternion(one)[1:] for one in turned]).reshape(-1)
    return float(max(np.max(np.abs(p), initial=0.0), 2.0 * np.max(np.abs(e), initial=0.0)))


def energy_drift(found: Record, run: Run) -> float | None:
    """Give the largest departure of the kinetic energy from the work of all that acts, J; None if there is none."""
    if found.kinetic is None or not run.work:
        return None
    return float(np.max(np.abs(found.kinetic - found.kinetic[0] - np.array(run.work[: len(found.kinetic)]))))


def _directions(chain: Chain) -> Array:
    """[n, 6] velocity of each link relative to its parent for a unit rate, link axes."""
    found = np.zeros((len(chain.links), 6))
    for h, link in zip(found, chain.links, strict=True):
        h[2] = 1.0 if link.type == "prismatic" else float(link.pitch)
        h[5] = 0.0 if link.type == "prismatic" else 1.0
    return found


def columns(mechanism: Mechanism, found: Record) -> Iterator[tuple[str, Array]]:
    """Name and values of every column of ``trajectory.csv``, in its order."""
    chain = mechanism.chain
    yield "t", found.t
    for k, link in enumerate(chain.links):
        yield from ((f"{link.name}.{name}", getattr(found, name)[:, k]) for name in ("q", "qd", "qdd"))
        if found.tau is not None:
            yield f"{link.name}.tau", found.tau[:, k]
    if found.effort is not None:
        names = (chain.links[k].name for k in mechanism.part.v)
        yield from ((f"{name}.effort", values) for name, values in zip(names, found.effort.T, strict=True))
    if found.reaction is not None:
        for k, cut in enumerate(chain.cuts):
            yield from ((f"cut.{cut.name}.{axis}", found.reaction[:, 6 * k + i]) for i, axis in enumerate(AXES))
    if found.wrenches is not None:
        for k, link in enumerate(chain.links):
            yield from ((f"{link.name}.{axis}", found.wrenches[:, k, i]) for i, axis in enumerate(AXES))
    first = len(chain.links) + 2 * len(chain.cuts)
    for k, effector in enumerate(chain.effectors):
        poses = found.frames[:, first + k]
        names = (f"effector.{effector.name}.{word}" for word in ("rx", "ry", "rz", "qw", "qx", "qy", "qz"))
        values = np.concatenate([poses[:, :, 3], quaternions(poses[:, :, :3])], axis=1)
        yield from zip(names, values.T, strict=True)


def quaternions(rotations: Array) -> Array:
    """Quaternions w x y z [k, 4] of rotations [k, 3, 3]; each is near the one before."""
    found = np.array([quaternion(R) for R in rotations])
    turns_over = np.sum(found[1:] * found[:-1], axis=1) < 0
    signs = np.cumprod(np.where(turns_over, -1.0, 1.0))
    return np.concatenate([found[:1], found[1:] * signs[:, None]])


def as_csv(mechanism: Mechanism, found: Record) -> str:
    """Write ``trajectory.csv``: 17 digits, one line a time."""
    named = list(columns(mechanism, found))
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([name for name, _ in named])
    for line in zip(*(values.tolist() for _, values in named), strict=True):
        writer.writerow([f"{value:.17g}" for value in line])
    return text.getvalue()
