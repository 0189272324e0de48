"""A sweep from the command line: which poses, their indices, and what is told of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from codegen.errors import Mistake, SpecificationError
from codegen.measure.compile import compiler
from codegen.output import Writer
from codegen.platforms.attitudes import Array
from codegen.platforms.cluster import sweep_on
from codegen.platforms.grid import Poses, for_grid, grid, poses_of_file
from codegen.platforms.results import check_format, results_file
from codegen.platforms.spool import Spool, pieces, spool
from codegen.platforms.sweep import Progress, kernel, sweep
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
        files: path -> what writes it.
    """

    poses: Poses
    columns: tuple[str, ...]
    values: Spool
    files: dict[str, Writer]

    def column(self, name: str) -> Array:
        """The values [poses] of a column, read when they are looked at."""
        return self.values.column(self.columns.index(name))

    @property
    def words(self) -> str:
        """What was found, in a line."""
        told = f"{self.poses.count} poses in {', '.join(self.files)}"
        if "status" not in self.columns:
            return told
        status = self.column("status")
        parts = [status[first:last] for first, last in pieces(self.poses.count)]
        singular = sum(int((part % 8 >= 4).sum()) for part in parts)
        none = sum(int((part >= 8).sum()) for part in parts)
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


def evaluated(
    wanted: Sweep, progress: Progress = lambda _: None, cluster: str | None = None, folder: Path | None = None
) -> Table:
    """Evaluate all wanted quantities at all poses.

    Args:
        wanted: what and where.
        progress: told each piece.
        cluster: address of a Dask scheduler; this machine if left out.
        folder: where there is room for the numbers; that for temporary files if left out.

    Raises:
        SpecificationError: Dask is not installed, or there is no scheduler.
        OutputError: there is no room.
    """
    compiled = kernel(wanted.platform)
    columns = (*wanted.poses.names, *compiled.names())
    found = spool(len(columns), wanted.poses.count, folder)
    if cluster is None:
        sweep(compiled, wanted.poses, found, progress)
    else:
        sweep_on(cluster, wanted.platform, wanted.poses, found, progress)
    return Table(wanted.poses, columns, found, results_file(columns, found, wanted.kind))
