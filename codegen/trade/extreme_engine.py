"""The rank of a whole mechanism: the in-line engine over a turn of its crank, through both dead centres."""

from __future__ import annotations

import numpy as np
from scipy.linalg import qr

from codegen.trade.engine import Array, closed, jacobian
from codegen.trade.extreme_table import Cell, ExtremeTable

ANGLES = (0, 1, 30, 60, 90, 120, 150, 179, 180)
"""Of the crank, degrees; 0 and 180 are dead centres."""

FORMS = (("conventional", None), ("parametric", "regular"), ("parametric", "table4"))
_ORDINARY = 0.9
"""An angle that is nothing special, rad: rows are chosen there."""

_TOLERANCE = 1e-9
"""Of singular values that count, over the largest."""


def kept_rows(form: str, rows: str | None) -> list[int]:
    """Independent rows of the engine at an ordinary angle, by QR with pivoting."""
    matrix = jacobian(form, rows, closed(_ORDINARY))
    _, R, order = qr(matrix.T, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(R))
    return sorted(int(k) for k in order[: int(np.sum(sizes > _TOLERANCE * sizes[0]))])


def singular_values_at(form: str, rows: str | None, degrees: float) -> Array:
    """Singular values of the rows that were kept, in m and rad."""
    matrix = jacobian(form, rows, closed(np.deg2rad(degrees)))[kept_rows(form, rows)]
    return np.asarray(np.linalg.svd(matrix, compute_uv=False))


def engine_rank() -> ExtremeTable:
    """Rank and smallest singular value in each form."""
    lines: list[tuple[Cell, ...]] = []
    for form, rows in FORMS:
        found = [singular_values_at(form, rows, degrees) for degrees in ANGLES]
        name, kept = " ".join(word for word in (form, rows) if word), float(len(found[0]))
        ranks = (float(np.sum(sigmas > _TOLERANCE * sigmas[0])) for sigmas in found)
        lines.append((name, "rank", kept, *ranks))
        lines.append((name, "smallest singular value", kept, *(float(sigmas[-1]) for sigmas in found)))
    return ExtremeTable(
        "engine",
        "Rank of phi_q of the in-line engine over the angle of its crank",
        ("form", "of the rows kept", "rows kept", *(f"{degrees} degrees" for degrees in ANGLES)),
        tuple(lines),
        (
            "Independent rows are chosen once, at 52 degrees; dead centres are at 0 and 180 degrees. Three rows of the",
            "planar loop are redundant. Rows table4 have lost three more where angles of joints are 0 or half a turn.",
        ),
    )
