"""A sweep on a Dask cluster: the pieces of `codegen.platforms.sweep`, many at a time, on other machines."""

from __future__ import annotations

from functools import cache
from itertools import islice
from typing import Any

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.platforms.attitudes import Array
from codegen.platforms.grid import Poses
from codegen.platforms.spool import Spool, pieces
from codegen.platforms.sweep import Kernel, Progress, kernel
from codegen.spec.platform import Platform

_WAIT = "10s"
"""How long a scheduler may take to answer."""

_AHEAD = 4
"""Pieces under way for each thread of a worker."""


def sweep_on(address: str, platform: Platform, poses: Poses, found: Spool, progress: Progress) -> None:
    """Evaluate all poses on a cluster.

    Args:
        address: of the scheduler.
        platform: whose quantities.
        poses: where.
        found: gets what `codegen.platforms.sweep.sweep` gives it.
        progress: told each piece.

    Raises:
        SpecificationError: Dask is not installed, or no scheduler answers.
        OutputError: there is no room for what is found.
    """
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        remedy = "pip install jointgen[dask], or leave --dask out"
        raise SpecificationError([Mistake("--dask", "Dask is not installed", remedy)]) from error
    try:
        client = Client(address, timeout=_WAIT)
    except (OSError, ValueError) as error:
        what = f"no scheduler answers at {address}"
        raise SpecificationError([Mistake("--dask", what, "give its address, such as tcp://host:8786")]) from error
    with client:
        everything = client.scatter((platform, poses), broadcast=True)

        def submitted(bounds: tuple[int, int]) -> Any:
            return client.submit(piece, everything, bounds, pure=False)

        waiting = pieces(poses.count)
        most = _AHEAD * sum(client.nthreads().values())
        running = as_completed([submitted(bounds) for bounds in islice(waiting, most)], with_results=True)
        for future, (bounds, values) in running:
            found.put(bounds[0], values)
            future.release()
            progress(f"{bounds[1]} poses")
            running.update([submitted(bounds) for bounds in islice(waiting, 1)])


def piece(wanted: tuple[Platform, Poses], bounds: tuple[int, int]) -> tuple[tuple[int, int], Array]:
    """Evaluate one piece in a worker; the code is compiled once in each."""
    platform, poses = wanted
    first, last = bounds
    return bounds, np.vstack([poses.columns(first, last), _kernel(platform).evaluate(poses, first, last)])


@cache
def _kernel(platform: Platform) -> Kernel:
    return kernel(platform)
