"""Candidates: source files of peers and of ours for one joint, generated or taken from an earlier run."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import re
import resource
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.peers.constraint import row_count
from benchmarks.peers.generate import UNUSABLE
from benchmarks.peers.work import Ours, Work, read_package

PEERS = {
    "casadi": "casadi",
    "sympy": "sympy",
    "symengine": "symengine",
    "symforce": "symforce",
    "wrenfold": "wrenfold",
    "eigen": "cmeel-eigen",
}
"""Peer -> Python package that brings it."""

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
BUILD = ROOT / "build" / "peers"
TIME_LIMIT = 600
REQUEST = ("--form", "conventional", "--variation", "body", "--outputs", "phi,phi_q,phi_q_t_lambda_q")
_SHARED = ("linear", "constraint", "formulas", "symbolic", "source", "work", "eigen", "generate")


@dataclass(frozen=True, slots=True)
class Candidate:
    """One function that does the work.

    Attributes:
        name: of the peer, ``ours`` or ``floor``.
        form: in which form the peer was fed.
        symbol: of the function.
        source: its file.
        includes: folders of headers.
        seconds: of the processor for generation; None where nothing was generated here.
    """

    name: str
    form: str
    symbol: str
    source: Path
    includes: tuple[str, ...] = ()
    seconds: float | None = None


class UnusablePeerError(Exception):
    """A peer cannot take part; the message says why."""


def children_seconds() -> float:
    """Processor seconds of all processes that were started from here and have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def version(peer: str) -> str:
    """Version of a peer's package, or what stands for it."""
    try:
        return importlib.metadata.version(PEERS[peer])
    except importlib.metadata.PackageNotFoundError:
        return "no package"


def peer_candidates(peer: str, joint: str, package: Path, work: Work) -> list[Candidate]:
    """Generate the candidates of a peer, unless an earlier run left the same ones.

    Raises:
        UnusablePeerError: it is not installed, failed, or took too long.
    """
    folder = BUILD / "sources" / peer / joint
    key, stamp = _key(peer, work), folder / "key"
    if not (stamp.exists() and stamp.read_text() == key):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        _generate(peer, joint, package, folder)
        stamp.write_text(key)
    records = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    return [
        Candidate(peer, r["form"], r["symbol"], folder / r["file"], tuple(r["includes"]), r["seconds"]) for r in records
    ]


def _generate(peer: str, joint: str, package: Path, folder: Path) -> None:
    command = [sys.executable, "-m", "benchmarks.peers.generate", peer, joint, str(package), str(folder)]
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=TIME_LIMIT, check=False)
    except subprocess.TimeoutExpired:
        raise UnusablePeerError(f"takes more than {TIME_LIMIT} s") from None
    if done.returncode == UNUSABLE:
        raise UnusablePeerError(done.stdout.strip() or "cannot be imported")
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise UnusablePeerError(f"fails: {said[-1]}")


def _key(peer: str, work: Work) -> str:
    digest = hashlib.sha256(f"{version(peer)} {work}".encode())
    paths = [HERE / f"{name}.py" for name in (*_SHARED, f"peer_{peer}")]
    for path in [*paths, *sorted((HERE / "eigen_routines").glob("*"))]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def generated_package(joint: str) -> tuple[Path, float]:
    """Generate our routines of a joint with the command line of jointgen.

    Returns:
        Folder of the package, processor seconds of the whole command.
    """
    folder = BUILD / "ours" / joint
    shutil.rmtree(folder, ignore_errors=True)
    start = children_seconds()
    command = [sys.executable, "-m", "codegen", "generate", joint, *REQUEST, "-o", str(folder)]
    subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    return folder, children_seconds() - start


def our_candidate(package: Ours, joint: str, label: str, seconds: float | None) -> Candidate:
    """Our routine out of a package, under a symbol of its own so that several packages can be compared."""
    record = package.functions[joint]
    text = (package.folder / record["source"]).read_text()
    name = re.sub(r"\W", "_", f"{label}_{joint}")
    folder = BUILD / "sources" / "ours" / name
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / f"{name}.c"
    source.write_text(f"#define {record['symbol']} {name}\n{_alone(text, record['symbol'])}")
    return Candidate(label, "jointgen", name, source, (str(package.folder.resolve() / "c/include"),), seconds)


def _alone(text: str, symbol: str) -> str:
    """The one routine of a source file, if it needs no other; compile time is then that of the routine."""
    body = re.search(rf"^void {symbol}\(.*?^\}}\n", text, re.MULTILINE | re.DOTALL)
    head = "".join(line + "\n" for line in text.splitlines() if line.startswith("#"))
    if body is None or re.search(r"^(#define|typedef|static)", text, re.MULTILINE):
        return text
    defined = re.findall(r"^\w[^;{}]*?\b(\w+)\([^;{}]*\)\s*\{", text, re.MULTILINE)
    called = set(re.findall(r"\b(\w+)\(", body[0].split("{", 1)[1]))
    return text if called & set(defined) else head + body[0]


def floor_candidate(joint: str, work: Work, used: Sequence[str]) -> Candidate:
    """A routine that reads every input that matters once and writes every output once; the unit of memory traffic.

    Args:
        joint: name in the catalogue.
        work: the outputs.
        used: inputs that the constraint depends on, as C expressions.
    """
    from benchmarks.peers.source import c_function

    symbol = f"floor_{joint}"
    places = [f"{name}[{k}]" for name, length in work.lengths.items() for k in range(length)]
    count = max(len(places), len(used))
    terms: dict[str, list[str]] = {place: [] for place in places}
    for k in range(count):
        terms[places[k % len(places)]].append(used[k % len(used)])
    statements = [f"{place} = {' + '.join(values)};" for place, values in terms.items()]
    folder = BUILD / "sources" / "floor"
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / f"{symbol}.c"
    source.write_text(c_function(work, symbol, statements).text)
    return Candidate("floor", "copy", symbol, source)


def used_inputs(joint: str, work: Work) -> list[str]:
    """Inputs that the constraint depends on, lambda included."""
    import sympy

    from benchmarks.peers.constraint import Pose, geometry_of, matrix, phi
    from benchmarks.peers.peer_sympy import SympyAlgebra

    algebra = SympyAlgebra()
    arguments = {name: algebra.vector(name, length) for name, length in work.arguments.items()}
    pose = Pose(arguments["r_i"], matrix(arguments["A_i"]), arguments["r_j"], matrix(arguments["A_j"]))
    free = set().union(*(x.free_symbols for x in phi(joint, pose, geometry_of(arguments["geometry"]), sympy.atan2)))
    named = [symbol.name for name in arguments for symbol in arguments[name] if symbol in free or name == "lambda"]
    assert len(arguments["lambda"]) == row_count(joint)
    return named


def packages_of_ours(joints: Sequence[str]) -> dict[str, tuple[Ours, float]]:
    """Generate our package of each joint."""
    generated = {joint: generated_package(joint) for joint in joints}
    return {joint: (read_package(folder), seconds) for joint, (folder, seconds) in generated.items()}
