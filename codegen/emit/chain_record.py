"""What the manifest says of a chain as a whole: links, cuts, effectors, frames, rows."""

from __future__ import annotations

from typing import Any

from codegen.emit.chain_subject import ChainSubject
from codegen.mechanics.chain.model import ROW_NAMES


def chain_record(subject: ChainSubject) -> dict[str, Any]:
    """Describe a chain; names are those of its file, identifiers those in the names of parts."""
    chain = subject.chain
    rows = [(cut.name, name) for cut in chain.cuts for name in ROW_NAMES]
    kept = set(subject.rows)
    return {
        "name": chain.name,
        "base": chain.base,
        "links": [
            {
                "name": link.name,
                "identifier": identifier,
                "parent": link.parent,
                "type": link.type,
                "coordinate": number,
                "start": float(link.coordinate),
            }
            for number, (link, identifier) in enumerate(zip(chain.links, subject.links, strict=True))
        ],
        "cuts": [{"name": cut.name, "C": cut.base.link, "R": cut.far.link} for cut in chain.cuts],
        "effectors": [{"name": effector.name, "link": effector.frame.link} for effector in chain.effectors],
        "independent": [chain.index(independent.joint) for independent in chain.independents],
        "frames": list(subject.frame_names),
        "rows": [{"cut": cut, "row": name} for row, (cut, name) in enumerate(rows) if row in kept],
        "left_out": [{"cut": cut, "row": name} for row, (cut, name) in enumerate(rows) if row not in kept],
    }
