"""A sweep on a Dask cluster: the pieces of `codegen.platforms.sweep`, many at a time, on other machines."""

from __future__ import annotations

from functools import cache

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.platforms.attitudes import Array
from codegen.platforms.grid import Poses
from codegen.platforms.sweep import Kernel, Progress, kernel, pieces
from codegen.spec.platform import Platform

_WAIT = "10s"
"""How long a scheduler may take to answer."""


def sweep_on(address: str, platform: Platform, poses: Poses, results: int, progress: Progress) -> Array:
    """Evaluate all poses on a cluster.

    Args:
        address: of the scheduler.
        platform: whose quantities.
        poses: where.
        results: number of results a pose.
        progress: told each piece.

    Returns:
        [columns, poses] as `codegen.platforms.sweep.sweep`.

    Raises:
        SpecificationError: Dask is not installed, or no scheduler answers.
    """
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        remedy = "pip install jointgen[dask], or leave --dask out"
        raise SpecificationError([Mistake("--dask", "Dask is not installed", remedy)]) from error
    found = np.empty((len(poses.names) + results, poses.count))
    try:
        client = Client(address, timeout=_WAIT)
    except (OSError, ValueError) as error:
        what = f"no scheduler answers at {address}"
        raise SpecificationError([Mistake("--dask", what, "give its address, such as tcp://host:8786")]) from error
    with client:
        everything = client.scatter((platform, poses), broadcast=True)
        futures = [client.submit(piece, everything, bounds, pure=False) for bounds in pieces(poses.count)]
        for future, (bounds, values) in as_completed(futures, with_results=True):
            found[:, bounds[0] : bounds[1]] = values
            future.release()
            progress(f"{bounds[1]} poses")
    return found


def piece(wanted: tuple[Platform, Poses], bounds: tuple[int, int]) -> tuple[tuple[int, int], Array]:
    """Evaluate one piece in a worker; the code is compiled once in each."""
    platform, poses = wanted
    first, last = bounds
    return bounds, np.vstack([poses.columns(first, last), _kernel(platform).evaluate(poses, first, last)])


@cache
def _kernel(platform: Platform) -> Kernel:
    return kernel(platform)
