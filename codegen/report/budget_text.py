"""The answer of `jointgen budget` in words."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.report.sheets import Document

_ASSUMPTIONS = (
    "assumed: inputs within the domain, rounded from ideal geometry; no overflow; round to nearest; sine and cosine",
    "within one unit in the last place, arc tangent within 1.5; errors are over the scale of the block",
)
_WHY = {
    "PROVEN": "the bound over the whole domain is within the budget",
    "MEASURED": "twice the largest error found is within the budget, the bound is not",
    "IMPOSSIBLE": "no candidate is within the budget; the best one:",
}


def budget_lines(document: Document, again: str, most_losers: int = 5) -> list[str]:
    """Write the answer.

    Args:
        document: of :mod:`codegen.trade.budget`.
        again: the command that asked, for the worst pose.
        most_losers: how many of the faster candidates are listed.
    """
    chosen, losers = document["chosen"], document["losers"]
    lines = [
        f"{document['verdict']}: {_WHY[document['verdict']]}",
        f"  {chosen['routine']}, {chosen['build']}: {chosen['nanoseconds']:.1f} ns ({chosen['flags']})",
        f"  {_errors(chosen)}",
        f"  worst in {chosen['block']}; its inputs: {again} --worst",
        *(f"  {line}" for line in _ASSUMPTIONS),
    ]
    if document["verdict"] == "IMPOSSIBLE":
        lines += [f"  rounded inputs alone make {chosen['floor']:.1e}", *_cures(document["cures"])]
        return lines
    lines += [f"  faster, but over the budget: {len(losers)}"] if losers else []
    lines += [f"    {loser['routine']}, {loser['build']}: {_errors(loser)}" for loser in losers[:most_losers]]
    return lines


def _errors(judgement: Document) -> str:
    return (
        f"sampled {judgement['sampled']:.1e}, searched {judgement['searched']:.1e}, "
        f"guaranteed {judgement['guaranteed']:.1e}, floor of the inputs {judgement['floor']:.1e}"
    )


def _cures(cures: Sequence[Document]) -> list[str]:
    if not cures:
        return ["  no change of the inputs helps: a wider number type would"]
    return [f"  {cure['name']}: {cure['searched']:.1e}, {cure['nanoseconds']:.1f} ns" for cure in cures]
