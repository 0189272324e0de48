"""A sweep from the command line: which poses, their indices, and what is told of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.measure.compile import compiler
from codegen.platforms.attitudes import Array
from codegen.platforms.cluster import sweep_on
from codegen.platforms.grid import Poses, for_grid, grid, poses_of_file
from codegen.platforms.results import check_format, results_file
from codegen.platforms.sweep import Progress, kernel, pieces, sweep
from codegen.spec.platform import Platform


@dataclass(frozen=True)
class Sweep:
    """What is to be evaluated.

    Attributes:
        platform: as its routines take poses here.
        poses: where.
        kind: of the results' file.
    """

    platform: Platform
    poses: Poses
    kind: str

    @property
    def pieces(self) -> int:
        """Number of times that progress is told."""
        return sum(1 for _ in pieces(self.poses.count))


@dataclass(frozen=True)
class Table:
    """Results of a sweep.

    Attributes:
        poses: where.
        columns: names.
        values: [columns, poses].
        files: path -> content.
    """

    poses: Poses
    columns: tuple[str, ...]
    values: Array
    files: dict[str, bytes]

    def column(self, name: str) -> Array:
        """The values [poses] of a column."""
        return np.asarray(self.values[self.columns.index(name)])

    @property
    def words(self) -> str:
        """What was found, in a line."""
        told = f"{self.poses.count} poses in {', '.join(self.files)}"
        if "status" not in self.columns:
            return told
        status = self.column("status")
        singular, none = int((status % 8 >= 4).sum()), int((status >= 8).sum())
        return f"{told}: {singular} singular, {none} without a number"


def chosen_poses(platform: Platform, file: Path | None, text: str | None, kind: str) -> Sweep | None:
    """Read what the command line says of poses; None for nothing.

    Raises:
        SpecificationError: the grid, the file or the format are wrong, or there is no compiler.
    """
    if file is not None and text is not None:
        raise SpecificationError([Mistake("--grid", "stands beside --poses", "give one of them")])
    check_format(kind)
    if file is None and text is None:
        return None
    compiler()
    if text is not None:
        return Sweep(for_grid(platform), grid(text), kind)
    assert file is not None
    return Sweep(platform, poses_of_file(file, platform), kind)


def evaluated(wanted: Sweep, progress: Progress = lambda _: None, cluster: str | None = None) -> Table:
    """Evaluate all wanted quantities at all poses.

    Args:
        wanted: what and where.
        progress: told each piece.
        cluster: address of a Dask scheduler; this machine if left out.

    Raises:
        SpecificationError: Dask is not installed, or there is no scheduler.
    """
    compiled = kernel(wanted.platform)
    if cluster is None:
        values = sweep(compiled, wanted.poses, progress)
    else:
        values = sweep_on(cluster, wanted.platform, wanted.poses, len(compiled.names()), progress)
    columns = (*wanted.poses.names, *compiled.names())
    return Table(wanted.poses, columns, values, results_file(columns, values, wanted.kind))
