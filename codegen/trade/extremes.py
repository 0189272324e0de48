"""All tables of extremes."""

from __future__ import annotations

from collections.abc import Callable

from codegen.trade.extreme_basins import basins
from codegen.trade.extreme_engine import engine_rank
from codegen.trade.extreme_nan import nans
from codegen.trade.extreme_numbers import lengths, multipliers
from codegen.trade.extreme_places import angles, distances, drifts, turns
from codegen.trade.extreme_rank import gimbal_lock, singular_values
from codegen.trade.extreme_table import ExtremeTable
from codegen.trade.newton import newton_table

TABLES: tuple[Callable[[], ExtremeTable], ...] = (
    distances,
    angles,
    turns,
    drifts,
    singular_values,
    gimbal_lock,
    engine_rank,
    multipliers,
    lengths,
    nans,
    basins,
    newton_table,
)


def extreme_tables(progress: Callable[[str], None] = lambda _: None) -> tuple[ExtremeTable, ...]:
    """Compute every table; ``progress`` is told the name of each."""
    found = []
    for table in TABLES:
        found.append(table())
        progress(found[-1].name)
    return tuple(found)
