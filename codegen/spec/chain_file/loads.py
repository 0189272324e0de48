"""What moves a chain: independent coordinates with their motions, forces and the conditions under which they act."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from codegen.errors import Mistake
from codegen.spec.chain import BASE_COORDINATES
from codegen.spec.chain_file.entries import ChainEntry, ConditionEntry, ForceEntry, IndependentEntry
from codegen.spec.chain_forces import Condition, EffectorForce, JointForce, WorldForce
from codegen.spec.chain_motions import Harmonic, Independent, Motion, Polynomial, Table
from codegen.spec.scene_file.text import nearest_known, quoted, shown

_MOTIONS = ("polynomial", "harmonic", "table")
_JOINT_KEYS = frozenset({"constant", "stiffness", "damping", "rest"})
_EFFECTOR_KEYS = frozenset({"force", "moment", "axes"})


def independent_mistakes(entry: ChainEntry, links: Sequence[str]) -> Iterator[Mistake]:
    """Check the independent coordinates."""
    seen: set[str] = set()
    known = (*links, *(BASE_COORDINATES if entry.base == "moving" else ()))
    for part in entry.independent:
        yield from _joint_mistakes(part.joint, part.place, known)
        if part.joint is not None and part.joint in seen:
            yield Mistake(part.place, f"the coordinate of {quoted(part.joint)} is named twice", "name it once")
        seen |= {part.joint} if part.joint is not None else set()
        motions = [key for key in _MOTIONS if key in part.given]
        if len(motions) > 1:
            yield Mistake(part.place, f"has {' and '.join(motions)}", "give one motion")
        if "polynomial" in part.given and not part.polynomial and "polynomial" not in part.wrong:
            yield Mistake(f"{part.place}: polynomial", "is empty", "give at least the constant")
        if part.driven:
            yield from _driven_mistakes(part, motions)
    if entry.cut and not _of(entry, is_base=False):
        what = "a chain with cuts has dependent coordinates, and no coordinate is said to be independent"
        yield Mistake(entry.place, what, "write [[independent]] for each degree of freedom")


def _driven_mistakes(entry: IndependentEntry, motions: Sequence[str]) -> Iterator[Mistake]:
    """A coordinate that is driven has a motion, and starts with it."""
    if not motions:
        yield Mistake(f"{entry.place}: driven", "has no motion", f"give {' or '.join(_MOTIONS)}, or leave driven out")
    for key in ("position", "speed"):
        if key in entry.given:
            yield Mistake(f"{entry.place}: {key}", "a driven coordinate starts with its motion", f"leave {key} out")


def force_mistakes(entry: ForceEntry, links: Sequence[str], effectors: Sequence[str]) -> Iterator[Mistake]:
    """Check one force."""
    if (entry.joint is None) == (entry.effector is None) and not {"joint", "effector"} & entry.wrong:
        yield Mistake(entry.place, "acts on a joint or at an effector", "give joint = … or effector = …, one of them")
        return
    yield from _joint_mistakes(entry.joint, entry.place, links)
    if entry.effector is not None and entry.effector not in effectors:
        what = f"there is no effector {quoted(entry.effector)}"
        remedy = nearest_known(entry.effector, effectors) if effectors else "write [[effector]] first"
        yield Mistake(f"{entry.place}: effector", what, remedy)
    foreign = (_EFFECTOR_KEYS if entry.joint is not None else _JOINT_KEYS) & entry.given
    if foreign:
        owner = "an effector" if entry.joint is not None else "a joint"
        yield Mistake(entry.place, f"{', '.join(sorted(foreign))} is for {owner}", "leave it out")
    for key in ("stiffness", "damping"):
        if getattr(entry, key) < 0:
            yield Mistake(f"{entry.place}: {key}", f"is {shown(getattr(entry, key))}", "give 0 or more")
    if entry.when is not None:
        yield from _condition_mistakes(entry.when, links)


def _joint_mistakes(joint: str | None, place: str, links: Sequence[str]) -> Iterator[Mistake]:
    if joint is not None and joint not in links:
        yield Mistake(f"{place}: joint", f"there is no link {quoted(joint)}", nearest_known(joint, links))


def _condition_mistakes(entry: ConditionEntry, links: Sequence[str]) -> Iterator[Mistake]:
    yield from _joint_mistakes(entry.joint, entry.place, links)
    if entry.lower is not None and entry.upper is not None and entry.lower >= entry.upper:
        what = f"lower, {shown(entry.lower)}, is not below upper, {shown(entry.upper)}"
        yield Mistake(entry.place, what, "give lower < upper")


def make_independents(entry: ChainEntry) -> tuple[Independent, ...]:
    """Make the independent coordinates of links; all of them where there are no cuts and none is named."""
    return _of(entry, is_base=False) or tuple(Independent(link.name or "") for link in entry.link)


def make_base_independents(entry: ChainEntry) -> tuple[Independent, ...]:
    """Make the coordinates of a moving base that are named."""
    return _of(entry, is_base=True)


def _of(entry: ChainEntry, is_base: bool) -> tuple[Independent, ...]:
    known = BASE_COORDINATES if entry.base == "moving" else ()
    return tuple(
        Independent(part.joint or "", _motion(part), part.position, part.speed, part.driven)
        for part in entry.independent
        if (part.joint in known) == is_base
    )


def _motion(entry: IndependentEntry) -> Motion | None:
    if entry.polynomial:
        return Polynomial(entry.polynomial)
    if entry.harmonic is not None:
        sine, none = entry.harmonic, Fraction(0)
        return Harmonic(sine.mean, sine.amplitude or none, sine.frequency or none, sine.phase, sine.speed)
    return Table(entry.table) if entry.table is not None else None


def make_forces(entry: ChainEntry) -> tuple[tuple[JointForce, ...], tuple[EffectorForce, ...]]:
    """Make the forces on joints and those at effectors."""
    joints = [
        JointForce(f.joint, f.constant, f.stiffness, f.damping, f.rest, _condition(f.when))
        for f in entry.force
        if f.joint is not None
    ]
    effectors = [
        EffectorForce(f.effector, f.force, f.moment, _condition(f.when))
        for f in entry.force
        if f.effector is not None and f.axes == "effector"
    ]
    return tuple(joints), tuple(effectors)


def make_world_forces(entry: ChainEntry) -> tuple[WorldForce, ...]:
    """Make the forces at effectors in axes that do not turn with them."""
    return tuple(
        WorldForce(f.effector, f.force, f.moment, _condition(f.when))
        for f in entry.force
        if f.effector is not None and f.axes == "world"
    )


def acts_on_joints(entry: ChainEntry) -> bool:
    """Whether forces act on coordinates at all times, or stops do."""
    return bool(entry.stop) or any(force.joint is not None and force.when is None for force in entry.force)


def acts_at_effectors(entry: ChainEntry) -> bool:
    """Whether forces act at effectors at all times, or springs do."""
    own = any(any((*effector.force, *effector.moment)) for effector in entry.effector)
    lasting = any(force.effector is not None and force.when is None for force in entry.force)
    return own or lasting or bool(entry.spring)


def _condition(entry: ConditionEntry | None) -> Condition | None:
    return None if entry is None else Condition(entry.joint or "", entry.lower, entry.upper, entry.sign)
