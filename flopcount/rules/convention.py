"""The paper's counting convention in words: the rules R0 to R5, and how each of them is read.

Input: none. Output: text for reports. `flopcount.rules.ledger` is the same in code. The paper states no
rules; these were found from its numbers. Where a rule could be read in several ways, the reading is the one
that holds in every cell at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule of the convention.

    Attributes:
        statement: what it says.
        reading: how it is applied where it could be read in several ways.
    """

    statement: str
    reading: str


RULES: Mapping[str, Rule] = MappingProxyType(
    {
        "R0": Rule(
            statement="Free: A_i, A_j, A_ij, dA_ij/dalpha, d_ij, body-fixed vectors, constants, lambda, "
            "sines and cosines; sign, transpose, v to v~.",
            reading="The pitch vector p h_i is a body-fixed vector, and p lambda a multiplier. Products of "
            "these are not free, even where all factors are constant (f_i^T s_i~, A_ij s_j~).",
        ),
        "R1": Rule(
            statement="Every multiplication and every addition is 1, schoolbook on structural non-zeros: "
            "matrix x skew 27, skew x skew 15, matrix x matrix 45, matrix x vector 15, skew x "
            "vector 9, dot 5, scalar x vector 3, scalar x matrix 9; a skew matrix is three "
            "numbers (scaling 3, skew + skew 3, matrix + skew 6, matrix + matrix 9).",
            reading="Scalars too: c1 c2 is 1. Products of scalars go from left to right, the multiplier "
            "first and the angle that acts last on the body's axes last (alpha_1 for body i, the "
            "last angle for body j).",
        ),
        "R2": Rule(
            statement="A matrix x skew product is formed first, then from left to right.",
            reading="Brackets stay as the paper prints them: a matrix in front of a bracket waits for it, "
            "but a row in front of one is multiplied in, since all that it meets becomes a row. "
            "This makes the same bracket A_i^T d_ij~ A_i + s_i~ cost f_i^T (...) 69 in dot-2's "
            "phi_q and f_i~ (...) 105 in its second derivative.",
        ),
        "R3": Rule(
            statement="Sub-products are shared inside one block (row) only; a block equal to +/- or the "
            "transpose of a finished one is free, and may be an operand.",
            reading="In phi_q the unit of sharing is one scalar row (in rot) or one block row; in the "
            "second derivative it is a block and its mirror image, (pi_j, pi_i) and (pi_i, pi_j). "
            "An operand is a run of factors as printed, not one that appears when a bracket is "
            "multiplied out; it takes precedence over R2. Blocks are formed column by column, "
            "(Phi_Z^T lambda)_alpha before (Phi_alpha^T lambda)_alpha, whose entries are blocks: "
            "in rot3 the entry (alpha_2, alpha_2) takes the finished (alpha_1, alpha_1) as a term, "
            "but (alpha_3, alpha_3) cannot take a term out of it.",
        ),
        "R4": Rule(
            statement="In a scalar constraint's second derivative each distinct block is scaled by lambda (9).",
            reading="Each distinct product of a block is scaled once. What contains a finished block as an "
            "operand has its lambda already: (pi_j, pi_j) of dot-2 and screw is -(pi_j, pi_i) "
            "A_ij. In screw the product A_ij^T h_i~ is formed once for s_j~ A_ij^T h_i~ and for p "
            "A_ij^T h_i~, and each of these two is scaled, by lambda and by p lambda: 276, as "
            "printed. The same block costs 285 with p first and lambda on the sum, and 303 with "
            "A_ij^T (p h_i)~. Likewise dot-1, whose blocks the paper does not print, costs 141 with "
            "(A_ij h_j)~, and 153 if grouped as eq. (9) groups dot-2.",
        ),
        "R5": Rule(
            statement="trn and rot are added; A_ij s_j~ is always counted; Phi_alpha is free.",
            reading="The counts are added, not the matrices: where trn and rot both fill a block of the "
            "second derivative, the additions that join them are not counted. A_ij s_j~ counts in "
            "a translational joint too, where it is constant. Products of sines and cosines in "
            "Phi_alpha of rot3 are not counted; those of (Phi_alpha^T lambda)_alpha are.",
        ),
    }
)
"""The rules by name."""
