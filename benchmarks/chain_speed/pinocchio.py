"""Pinocchio on the same chain: its model is made from a table of frames, the program is compiled once.

Headers and library are those of the package ``pin`` (extra ``bench``); compiling takes minutes.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import casadi

from codegen.mechanics.chain.tree import Node, Tree
from codegen.spec.chain import Chain, Link

HERE = Path(__file__).parent
FLAGS = ("-std=c++17", "-O2", "-DNDEBUG")
_TYPES = {"revolute": 0, "prismatic": 1, "fixed": 2}
_LIMITS = {
    "BOOST_MPL_LIMIT_LIST_SIZE": 30,
    "BOOST_MPL_LIMIT_VECTOR_SIZE": 30,
    "BOOST_FUSION_INVOKE_MAX_ARITY": 12,
    "FUSION_MAX_VECTOR_SIZE": 12,
}


def prefix() -> Path | None:
    """The folder with Pinocchio's ``include`` and ``lib``; None where the package is not installed."""
    found = find_spec("pinocchio")
    if found is None or found.origin is None:
        return None
    return next((folder for folder in Path(found.origin).parents if (folder / "include/pinocchio").is_dir()), None)


@cache
def compiled(folder: Path) -> Path:
    """The program, compiled into a folder; with the routines that Pinocchio's library holds."""
    where = prefix()
    assert where is not None
    eigen = next(p for p in (where / "include/eigen3", Path(casadi.__file__).parent / "include/eigen3") if p.is_dir())
    limits = [f"-D{name}={value}" for name, value in _LIMITS.items()]
    limits += ["-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION"]
    command = ["g++", *FLAGS, *limits, f"-I{where / 'include'}", f"-I{eigen}", str(HERE / "pinocchio.cpp")]
    command += ["-o", str(folder / "pinocchio"), f"-L{where / 'lib'}", "-lpinocchio_default"]
    subprocess.run([*command, f"-Wl,-rpath,{where / 'lib'}"], check=True)
    return folder / "pinocchio"


def table(chain: Chain, q: Sequence[Any], qd: Sequence[Any]) -> str:
    """The chain as the program reads it."""
    tree = Tree(chain)
    links: list[Link | None] = [*chain.links, *[None] * (2 * len(chain.cuts))]
    lines = [f"{len(chain.links)} {len(chain.cuts)}", _numbers(chain.gravity), _numbers(q), _numbers(qd)]
    lines += [_frame(node, link) for node, link in zip(tree.nodes, links, strict=False)]
    return "\n".join(lines) + "\n"


def _frame(node: Node, link: Link | None) -> str:
    turn = node.turn if node.type == "revolute" else node.fixed_turn
    none = (0, 0, 0)
    mass, centre, inertia = (link.mass, link.centre, link.inertia) if link else (0, none, (none, none, none))
    parts = [_entries(turn), node.arm, [mass], centre, _entries(inertia)]
    return f"{node.parent} {_TYPES[node.type]} " + " ".join(_numbers(part) for part in parts)


def _entries(matrix: Any) -> Iterator[Any]:
    return (value for row in matrix for value in row)


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)
