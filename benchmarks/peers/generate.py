"""Generate the candidates of one peer and joint, in a process of its own: a tool may crash, hang or be absent.

``python -m benchmarks.peers.generate PEER JOINT PACKAGE FOLDER``; exit code 3: the peer cannot be used here, one line
on standard output says why.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
from pathlib import Path

from benchmarks.peers.work import read_package

UNUSABLE = 3


def symbol_of(peer: str, form: str, joint: str) -> str:
    """C symbol of a candidate."""
    return f"{peer}_{form}_{joint}".replace(" ", "_")


def main(peer: str, joint: str, package: str, folder: str) -> int:
    """Write the source and a record of each form."""
    try:
        module = importlib.import_module(f"benchmarks.peers.peer_{peer}")
    except ImportError as error:
        print(error)
        return UNUSABLE
    work = read_package(Path(package)).work(joint)
    for form in module.FORMS:
        symbol = symbol_of(peer, form, joint)
        start = time.process_time()
        try:
            source = module.write(work, form, symbol)
        except ModuleNotFoundError as error:
            print(error)
            return UNUSABLE
        seconds = time.process_time() - start
        path = Path(folder) / f"{symbol}{source.ending}"
        path.write_text(source.text)
        record = {"form": form, "symbol": symbol, "file": path.name, "includes": source.includes, "seconds": seconds}
        (Path(folder) / f"{symbol}.json").write_text(json.dumps(record))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
