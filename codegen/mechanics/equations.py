"""Where the formulas of each quantity come from, for the comments of the emitted code."""

from __future__ import annotations

from codegen.spec.joints import JointType
from codegen.spec.request import Variant

_CONVENTIONAL: dict[str, str] = {
    "phi": "S1 Eq. (4), Table 1",
    "phi_q": "S1 Eqs. (5)-(8), signs of (6)-(8) corrected",
    "phi_q_t_lambda_q": "S1 Eq. (9), corrected",
    "gamma": "second time derivative of S1 Table 1",
    "phi_q_v": "S1 Eq. (5) along the velocity",
    "phi_q_t_lambda": "S1 Eqs. (1), (5)",
    "branch": "attitudes that satisfy S1 Table 1",
    "all": "S1 Table 1, Eqs. (4)-(9)",
}

_PARAMETRIC: dict[str, str] = {
    "phi": "S1 Eqs. (12), (16)-(18), Tables 3-5",
    "phi_q": "S1 Eqs. (13), (19)-(21), (26)-(33), (38)",
    "phi_q_t_lambda_q": "S1 Eqs. (14), (22)-(25), (34)-(37)",
    "gamma": "second time derivative of S1 Eq. (12)",
    "phi_q_v": "S1 Eqs. (19), (27) along the velocity",
    "phi_q_t_lambda": "S1 Eqs. (1), (13)",
    "branch": "trace of H^T C_i^T A_ij C_j, SPEC S1.2",
    "all": "S1 Eqs. (12)-(38), Tables 3-5",
}


def equations(joint: JointType, variant: Variant, output: str) -> str:
    """Name the equations behind a routine."""
    if variant.form == "conventional":
        return _CONVENTIONAL[output]
    rows = {"regular": "; regular rows: SPEC S1.2", "quaternion": "; quaternion rows: SPEC S1.2"}.get(
        variant.rows or "", ""
    )
    return f"{_PARAMETRIC[output]}; trn{joint.translations} + rot{joint.rotations}{rows}"
