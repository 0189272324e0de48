"""Joints to replace by freer ones, so that no row is redundant and the mechanism moves as before.

A self-stress is a set of joint forces in equilibrium without a load: one for each redundant row. A freer joint cannot
carry some of them. The stresses vanish exactly if the forces released are as many as the stresses and no stress
is without all of them; then nothing else has become free. Each suggestion is checked by the rank of the new system.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice

import numpy as np

from codegen.measure.constraints import Array, ConstraintSystem, Pose, Scales
from codegen.measure.freedoms import CARRIED, FREER, FreerJoint, carried_rows
from codegen.measure.rank import null_space, rank

MOST = 3
"""Suggestions that are given."""

_TRIED = 20000
"""Combinations that are looked at."""

_RELEASES = 1e-3
"""Stresses of length 1 are released beyond this."""

_USUAL = ("cylindrical", "ball", "revolute", "translational")


@dataclass(frozen=True, slots=True)
class Replacement:
    """A freer joint in the place of the joint at a position."""

    joint: int
    old: str
    new: str
    note: str


@dataclass(frozen=True, slots=True)
class Suggestion:
    """Replacements that belong together.

    Attributes:
        replacements: in the order of the joints.
        left: redundant rows that remain.
    """

    replacements: tuple[Replacement, ...]
    left: int


@dataclass(frozen=True, slots=True, eq=False)
class _Stresses:
    """A mechanism as forces and torques of its joints, at each of some poses.

    Attributes:
        labels: joint and label of each row.
        rows: [m, 6 nb] at each pose.
        stresses: [m, k] basis of the self-stresses at each pose.
    """

    labels: tuple[tuple[int, str], ...]
    rows: tuple[Array, ...]
    stresses: tuple[Array, ...]

    def released(self, joint: int, freer: FreerJoint) -> tuple[Array, ...]:
        """Give what a replacement takes off the stresses, [d, k] at each pose."""
        places = [self.labels.index((joint, label)) for label in freer.released]
        return tuple(stress[places] for stress in self.stresses)


Candidate = tuple[int, FreerJoint, tuple[Array, ...]]


def suggestions(system: ConstraintSystem, poses: Sequence[Pose], units: Scales, count: int) -> tuple[Suggestion, ...]:
    """Suggest joints to replace in a connected mechanism.

    One joint is replaced if one is enough, else two; more only where two are not enough, and then one joint after the
    other. Replacements of joints that lose rows come first. Joints with a prescribed motion stay.

    Args:
        system: the mechanism.
        poses: regular ones.
        units: see `codegen.measure.constraints.scales`.
        count: of redundant rows.

    Returns:
        At most `MOST`; those that leave redundant rows only where no other is found.
    """
    if not count:
        return ()
    model = _stresses(system, poses, units)
    if any(stress.shape[1] != count for stress in model.stresses):
        return ()
    candidates = [
        (position, freer, model.released(position, freer))
        for position in range(len(system.joints))
        if _is_free_to_move(system, position)
        for freer in FREER.get(system.joints[position].type, ())
    ]
    found = (
        _suggestion(system, chosen, 0)
        for chosen in sorted(_complete(candidates, count), key=_merit)
        if _is_confirmed(model, chosen, 0)
    )
    return tuple(islice(found, MOST)) or _one_by_one(system, model, candidates, count)


def _merit(chosen: Sequence[Candidate]) -> tuple[int, float]:
    """Order suggestions: joints that are easily bought first, then those that stay farthest from singular poses."""
    return sum(freer.type not in _USUAL for _, freer, _ in chosen), -round(_release(chosen), 2)


def _is_free_to_move(system: ConstraintSystem, position: int) -> bool:
    joint = system.joints[position]
    return len(joint.rows) - len(joint.coordinates) == len(CARRIED[joint.type])


def _stresses(system: ConstraintSystem, poses: Sequence[Pose], units: Scales) -> _Stresses:
    labels = [(position, label) for position, joint in enumerate(system.joints) for label in CARRIED[joint.type]]
    matrices = []
    for pose in poses:
        matrix = np.zeros((len(labels), 6 * len(system.bodies)))
        start = 0
        for joint in system.joints:
            block = carried_rows(joint, pose, CARRIED[joint.type], units.length)
            for body, part in zip(joint.bodies, (block[:, :6], block[:, 6:]), strict=True):
                if body is not None:
                    matrix[start : start + len(block), 6 * body : 6 * body + 6] += part
            start += len(block)
        matrices.append(matrix)
    return _Stresses(tuple(labels), tuple(matrices), tuple(null_space(matrix.T) for matrix in matrices))


def _complete(candidates: Sequence[Candidate], count: int) -> Iterator[tuple[Candidate, ...]]:
    """One or two joints whose replacement takes exactly all stresses off; two only where one is not enough."""
    tried = 0
    for number in (1, 2):
        is_found = False
        for chosen in combinations(candidates, number):
            tried += 1
            if tried > _TRIED:
                return
            is_apart = len({position for position, _, _ in chosen}) == number
            if is_apart and len(_labels(chosen)) == count and _release(chosen) > _RELEASES:
                is_found = True
                yield chosen
        if is_found:
            return


def _release(chosen: Sequence[Candidate]) -> float:
    """How well the released forces are independent on the stresses, 0 to 1, at the worst of the poses."""
    least = 1.0
    for per_pose in zip(*(released for _, _, released in chosen), strict=True):
        matrix = np.vstack(per_pose)
        sigma = np.linalg.svd(matrix, compute_uv=False)
        least = min(least, float(sigma[-1]) if len(sigma) == len(matrix) else 0.0)
    return least


def _one_by_one(
    system: ConstraintSystem, model: _Stresses, candidates: Sequence[Candidate], count: int
) -> tuple[Suggestion, ...]:
    """Replace joint after joint as long as each takes stresses off and sets nothing free."""
    chosen: list[Candidate] = []
    for candidate in sorted(candidates, key=lambda candidate: _merit([candidate])[0] - len(candidate[1].released)):
        is_new = all(candidate[0] != position for position, _, _ in chosen)
        if is_new and _release([*chosen, candidate]) > _RELEASES:
            chosen.append(candidate)
    chosen.sort(key=lambda candidate: candidate[0])
    left = count - len(_labels(chosen))
    return (_suggestion(system, chosen, left),) if chosen and _is_confirmed(model, chosen, left) else ()


def _labels(chosen: Sequence[Candidate]) -> list[tuple[int, str]]:
    return [(position, label) for position, freer, _ in chosen for label in freer.released]


def _is_confirmed(model: _Stresses, chosen: Sequence[Candidate], left: int) -> bool:
    """Compare ranks without the released rows: as many as before, less what remains redundant."""
    released = set(_labels(chosen))
    kept = [row for row, label in enumerate(model.labels) if label not in released]
    left_over = len(kept) - left
    return all(rank(matrix[kept]).rank == rank(matrix).rank == left_over for matrix in model.rows)


def _suggestion(system: ConstraintSystem, chosen: Sequence[Candidate], left: int) -> Suggestion:
    ordered = sorted(chosen, key=lambda candidate: candidate[0])
    return Suggestion(
        tuple(
            Replacement(position, system.joints[position].type, freer.type, freer.note)
            for position, freer, _ in ordered
        ),
        left,
    )
