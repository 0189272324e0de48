"""Writes the numbers of docs/errata.md: each block between <!-- numbers: NAME --> and <!-- end --> is made anew.

Run: .venv/bin/python -m tests.errata.render
Two digits are given of what is wrong, a bound of what is right, so that the page is the same on every machine.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from flopcount import paper

from . import motion, tables
from .claims import EXACT, Misprint, error, error_as_printed, error_corrected, size
from .confirmed import CONFIRMED
from .misprints import CONVENTIONAL, ROTATIONAL, TABLE_6, TRANSLATIONAL

PAGE = Path(__file__).parents[2] / "docs" / "errata.md"
BLOCK = re.compile(r"(<!-- numbers: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)

DRIFT = 1e-6  # of a motion by the Runge-Kutta method


def number(x: float, bound: float = EXACT) -> str:
    """Two digits, or the bound that it stays below."""
    return f"< {bound:.0e}" if abs(x) < bound else f"{x:#.2g}"


def table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """Markdown table."""
    lines = [head, ("---",) * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def misprints(listed: Iterable[Misprint]) -> str:
    """Deviations of misprinted equations."""
    head = ("equation", "part", "largest true entry", "as printed, off by", "corrected, off by")
    rows = (
        (m.equation, m.part, number(size(m)), number(error_as_printed(m)), number(error_corrected(m))) for m in listed
    )
    return table(head, rows)


def confirmed() -> str:
    """Deviations of equations that are right."""
    return table(
        ("equation", "what was checked", "as printed, off by"),
        ((c.equation, c.statement, number(error(c))) for c in CONFIRMED),
    )


def moving() -> str:
    """What row 3 of Eq. (32) does to a motion."""
    T, printed, corrected = motion.TORQUE, motion.as_printed, motion.as_corrected
    both = (printed, corrected)

    def line(what: str, values: Iterable[float], bound: float = EXACT) -> tuple[str, ...]:
        return (what, *(number(x, bound) for x in values))

    rows = [
        line(f"{what}, torque {torque:g} N m", (measure(torque, form) for form in both), bound)
        for what, measure, bound in (
            ("accelerations against action and reaction", motion.error_of_acceleration, EXACT),
            ("change of total angular momentum in 0.5 s", motion.drift_of_angular_momentum, DRIFT),
        )
        for torque in (0.0, T)
    ]
    rows += [
        (f"angle of the joint after 0.5 s against corrected, torque {torque:g} N m", number(value), "")
        for torque, value in ((t, motion.error_of_angle(t)) for t in (0.0, T))
    ]
    held = motion.error_with_body_i_held(T)
    no_torque = motion.error_of_acceleration(0.0, motion.with_row_2_as_printed)
    rows.append((f"accelerations against corrected where body i is the ground, torque {T:g} N m", number(held), ""))
    rows.append(line("alphadot from row 3 at given velocities of the bodies", map(motion.error_of_alpha_rate, both)))
    rows.append((f"Newton steps that close the joint from {motion.NEWTON_START:g} away", *map(steps, both)))
    rows.append(("accelerations, row 2 as printed and row 3 mended, torque 0 N m", number(no_torque), ""))
    return table(("quantity", "as printed, off by", "corrected, off by"), rows)


def steps(form: motion.Form) -> str:
    """Few or many steps of Newton's method; exact numbers would depend on the machine."""
    counts = motion.newton_steps(form)
    if max(counts) <= motion.NEWTON_FEW:
        return f"at most {motion.NEWTON_FEW}"
    return f"more than {motion.NEWTON_LIMIT - 1}" if min(counts) == motion.NEWTON_LIMIT else "some"


def planar() -> str:
    """Table 5, planar joint."""
    lines = (
        ("trn2 + rot0 (Table 5)", tables.planar_residual(tables.PLANAR_AS_PRINTED), tables.PLANAR_AS_PRINTED),
        ("trn2 + rot1 (corrected)", tables.planar_residual(tables.PLANAR_CORRECTED), tables.PLANAR_CORRECTED),
    )
    rows = [(name, number(residual), str(tables.freedom(joint))) for name, residual, joint in lines]
    rows.insert(0, ("conventional, Table 1", number(tables.planar_residual_conventional()), "3"))
    return table(("rows", "violation in planar poses turned about the normal", "degrees of freedom"), rows)


def printed_tables() -> str:
    """Misprints of the tables, from the data of the operation counts."""
    rows = ((n.place, n.printed, n.correct, n.reason) for n in paper.FOOTNOTES.values())
    return table(("place", "printed", "correct", "why"), rows)


def rank() -> str:
    """Rank of Table 4."""
    rows = []
    for joint, angles in tables.RANK_POSES:
        pi = ", ".join("pi" if angle == np.pi else f"{angle:g}" for angle in angles)
        smallest = (min(tables.smallest_singular_values(joint, name, angles)) for name in ("table4", "regular"))
        rows.append((joint, pi, *(number(float(x)) for x in smallest)))
    return table(("joint", "angles, rad", "smallest singular value, Table 4", "our regular rows"), rows)


def manifold() -> str:
    """What holds on the manifold only."""
    bare, mended = tables.eq_20_off_the_manifold()
    anywhere, along = tables.substitution()
    rows = (
        ("(20) at poses that violate the joint", number(bare)),
        ("the same with `phi~` added in the column of delta pi_i", number(mended)),
        ("(32), corrected, at poses that violate the joint", number(tables.eq_32_off_the_manifold())),
        ("second derivative by (22) to (25) and (34) to (37), corrected, against the exact one", number(anywhere)),
        ("the same, applied to directions that the joint allows", number(along)),
    )
    return table(("what", "off by"), rows)


BLOCKS: dict[str, Callable[[], str]] = {
    "conventional": lambda: misprints(CONVENTIONAL),
    "translational": lambda: misprints(TRANSLATIONAL),
    "rotational": lambda: misprints(ROTATIONAL),
    "motion": moving,
    "tables": printed_tables,
    "planar": planar,
    "table_6": lambda: misprints(TABLE_6.values()),
    "confirmed": confirmed,
    "manifold": manifold,
    "rank": rank,
}


def rendered(page: str) -> str:
    """The page with its numbers as they are now."""
    return BLOCK.sub(lambda match: match[1] + "\n" + BLOCKS[match[2]]() + "\n" + match[3], page)


def main() -> None:
    """Rewrite the page."""
    PAGE.write_text(rendered(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
