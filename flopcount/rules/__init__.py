"""The paper's way of counting, as a model: formulas as data, rules that price them, derivations.

Input: `flopcount.paper` (printed numbers, Tables 1 and 5) and the derivation of S1, corrected. Output:
Tables 2 and 7 by the rules R0 to R5, term by term, and a verdict on each printed number. Stages, each usable
alone:

1. `conventional`, `parametric`: the blocks of the derivatives as expressions (`expressions`, `trig`);
2. `ledger`: walks them and writes down each operation (`patterns`: its price; `identity`: what is free), in
   the paper's order of evaluation or in that of `vectors`;
3. `switches`: assumptions, off by default, that would explain printed cells which the rules do not give;
4. `tables`: the tables, `explain` and the verdicts.

No total is written down anywhere here. `evaluate` gives the value of the same expressions, for the proof
that the formulas which are counted are right; it alone needs numpy, and is imported by those who want it.
"""

from flopcount.rules.convention import RULES, Rule
from flopcount.rules.ledger import Term
from flopcount.rules.switches import SWITCHES, Cell, Form, Switch
from flopcount.rules.tables import (
    ORDERS,
    UnknownNameError,
    Verdict,
    cells,
    composed,
    explain,
    operations,
    parts,
    printed,
    tally,
    verdict,
    verdicts,
)

__all__ = [
    "ORDERS",
    "RULES",
    "SWITCHES",
    "Cell",
    "Form",
    "Rule",
    "Switch",
    "Term",
    "UnknownNameError",
    "Verdict",
    "cells",
    "composed",
    "explain",
    "operations",
    "parts",
    "printed",
    "tally",
    "verdict",
    "verdicts",
]
