"""From a chain to the files of its package."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

import codegen
from codegen.chains.programs import programs, routines
from codegen.chains.readme import readme
from codegen.emit.casadi import casadi_function, serialised
from codegen.emit.chain_record import chain_record
from codegen.emit.chain_subject import ChainSubject
from codegen.emit.routine import Routine
from codegen.emit.scene_package import ScenePackage, scene_files
from codegen.ir.ops import Constant
from codegen.mechanics.chain.model import kept_rows
from codegen.spec.chain import Chain
from flopcount.count import count

Progress = Callable[[str], None]
"""Told what is finished."""

_EQUATIONS = "S2 (corrected), for this chain"


def generate_chain(chain: Chain, real: str = "double", progress: Progress = lambda _: None) -> dict[str, bytes]:
    """Generate the package of a chain in memory.

    Args:
        chain: the chain.
        real: ``double`` or ``float``.
        progress: told each routine as it is done.

    Returns:
        Path below the package's folder -> content.
    """
    subject = ChainSubject(chain, kept_rows(chain))
    found: list[Routine] = []
    casadi: dict[str, bytes] = {}
    for output, made in programs(chain, routines(chain)):
        found.append(Routine(subject, output, made, count(made), _EQUATIONS))
        casadi[output] = serialised(casadi_function(subject.routine_stem(output), made))
        progress(output)
    specification = hashlib.sha256(repr((codegen.__version__, chain, real)).encode()).hexdigest()
    return scene_files(
        ScenePackage(
            chain.name,
            tuple(found),
            codegen.__version__,
            specification,
            real,
            chain_record(subject),
            casadi,
            start_arguments(chain),
            readme(subject, found, codegen.__version__, specification),
            "chain",
        )
    )


def steps(chain: Chain) -> int:
    """Number of times that progress is told."""
    return len(routines(chain))


def start_arguments(chain: Chain) -> Mapping[str, Sequence[Constant]]:
    """Every argument for the example: the coordinates of the file, joint velocities and accelerations of 1."""
    size = len(chain.links)
    one, none = Constant(Fraction(1)), Constant(Fraction(0))
    pose = [one if k in (0, 4, 8) else none for k in range(12)]
    return {
        "q": [Constant(link.coordinate) for link in chain.links],
        "qd": [one] * size,
        "qdd": [one] * size,
        "f_R": [one] * (6 * len(chain.cuts)),
        "f_E": [one] * (6 * len(chain.effectors)),
        "T_0": pose,
        "v_0": [none] * 6,
        "vd_0": [none] * 6,
    }
