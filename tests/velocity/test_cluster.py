"""A sweep on a local Dask cluster."""

from __future__ import annotations

import pytest

from codegen.errors import SpecificationError
from codegen.platforms.cluster import sweep_on
from codegen.platforms.grid import grid
from codegen.platforms.spool import CHUNK, spool

from .test_sweep import PLATFORM, compiled, swept

distributed = pytest.importorskip("distributed")


def test_a_cluster_gives_the_bits_of_this_machine() -> None:
    poses = grid(f"x=-0.3:0.3:{CHUNK},yaw=-0.5:0.5:3")
    told: list[str] = []
    found = spool(2 + len(compiled().names()), poses.count)
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None, protocol="tcp"
    ) as cluster:
        sweep_on(cluster.scheduler_address, PLATFORM, poses, found, told.append)
    assert (found.rows(0, poses.count) == swept(poses)).all()
    assert len(told) == 3


def test_a_scheduler_that_does_not_answer_is_told() -> None:
    with pytest.raises(SpecificationError, match="no scheduler answers"):
        sweep_on("tcp://127.0.0.1:1", PLATFORM, grid("x=0"), spool(10, 1), lambda _: None)
