"""The comparison of S1 Table 7: the paper's printed counts beside those of emitted routines.

Input: counts of programs, by joint, derivative and kind of routine. Output: rows of plain numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from flopcount.counts import Counts
from flopcount.paper import DERIVATIVES, TABLE_7

COLUMNS: tuple[tuple[str, str], ...] = (
    ("conventional", "conventional"),
    ("conventional_world", "conventional, world variation"),
    ("parametric", "parametric regular exact"),
    ("parametric_substituted", "parametric regular substituted"),
    ("parametric_table4", "parametric table4 exact"),
    ("parametric_table4_substituted", "parametric table4 substituted"),
)
"""Kinds of routine: key (the symbol less its joint) and words."""

BASE = "conventional"


@dataclass(frozen=True, slots=True)
class ComparisonRow:
    """One joint and derivative.

    Attributes:
        joint: name in the catalogue.
        derivative: ``phi_q`` or ``phi_q_t_lambda_q``.
        printed_conventional: the paper's count; None for a joint that is not in the paper.
        printed_parametric: likewise.
        emitted: kind of routine -> its counts.
    """

    joint: str
    derivative: str
    printed_conventional: int | None
    printed_parametric: int | None
    emitted: Mapping[str, Counts]

    @property
    def printed_rate(self) -> float | None:
        """Parametric over conventional in percent, from the printed counts."""
        if self.printed_conventional is None or self.printed_parametric is None:
            return None
        return 100.0 * self.printed_parametric / self.printed_conventional

    def rate(self, column: str) -> float | None:
        """A kind of routine over the conventional one in percent, from the emitted counts."""
        base = self.emitted.get(BASE)
        if base is None or base.total == 0 or column not in self.emitted:
            return None
        return 100.0 * self.emitted[column].total / base.total

    def as_dict(self) -> dict[str, object]:
        """Plain data, for JSON."""
        return {
            "joint": self.joint,
            "derivative": self.derivative,
            "printed": {
                "conventional": self.printed_conventional,
                "parametric": self.printed_parametric,
                "rate_percent": self.printed_rate,
            },
            "emitted": {
                column: counts.as_dict() | {"rate_percent": self.rate(column)}
                for column, counts in self.emitted.items()
            },
        }


def compare(emitted: Mapping[tuple[str, str], Mapping[str, Counts]]) -> tuple[ComparisonRow, ...]:
    """Put the printed counts beside the emitted ones.

    Args:
        emitted: (joint, derivative) -> kind of routine -> counts.
    """
    rows = []
    for (joint, derivative), counts in emitted.items():
        printed = TABLE_7.get(joint)
        known = [d for d in DERIVATIVES if d == derivative]
        rows.append(
            ComparisonRow(
                joint,
                derivative,
                printed.conventional.of(known[0]) if printed else None,
                printed.proposed.of(known[0]) if printed else None,
                counts,
            )
        )
    return tuple(rows)
