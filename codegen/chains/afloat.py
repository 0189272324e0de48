"""A chain on a moving base as one on a fixed base: six massless links carry what stood on the base."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from codegen.chains.relative.pose import Pose, row_of
from codegen.chains.relative.steps import Step
from codegen.spec.chain import BASE, BASE_COORDINATES, Chain, Frame, Link
from codegen.spec.chain_motions import Independent, Polynomial
from codegen.spec.placement import transposed
from codegen.spec.scene import ZERO_VECTOR

_STEPS = tuple(Step(kind, axis, 1, axis) for kind in ("prismatic", "revolute") for axis in range(3))
"""Of the base, as `BASE_COORDINATES` names them; the last turn is about z, so that its link has the base's axes."""

_LAST = BASE_COORDINATES[-1]
_AT_REST = Polynomial((Fraction(0),))


def afloat(chain: Chain) -> Chain:
    """Give the chain with the coordinates of its moving base as joints; a chain on a fixed base stays as it is.

    Coordinates of the base that no independent coordinate names rest at 0 where motions are prescribed, and where
    others of the base are driven.
    """
    if chain.base != "moving":
        return chain
    given = {one.joint: one for one in chain.base_independents}
    is_driven = any(one.driven for one in chain.base_independents)
    return replace(
        chain,
        base="fixed",
        links=(*_carriers(), *(replace(link, parent=_on(link.parent)) for link in chain.links)),
        cuts=tuple(replace(cut, base=_moved(cut.base), far=_moved(cut.far)) for cut in chain.cuts),
        effectors=tuple(replace(effector, frame=_moved(effector.frame)) for effector in chain.effectors),
        independents=(
            *(given.get(name, Independent(name, _AT_REST, driven=is_driven)) for name in BASE_COORDINATES),
            *chain.independents,
        ),
        base_independents=(),
    )


def _carriers() -> list[Link]:
    links: list[Link] = []
    parent, frame = BASE, Pose()
    for name, step in zip(BASE_COORDINATES, _STEPS, strict=True):
        row = row_of(frame @ Pose(step.turn))
        links.append(Link(name, parent, step.type, row, Fraction(0), ZERO_VECTOR, (ZERO_VECTOR,) * 3))
        parent, frame = name, Pose(transposed(step.turn))
    return links


def _on(link: str) -> str:
    return _LAST if link == BASE else link


def _moved(frame: Frame) -> Frame:
    return replace(frame, link=_on(frame.link))
