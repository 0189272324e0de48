"""The numbers of `templates/c/jg_trigonometry.h.j2`: minimax polynomials, and pi in pieces.

``python -m tests.trigonometry.coefficients`` derives them; a test holds this table against that derivation.
"""

from __future__ import annotations

_WIDE = ("JG_HALF_PI_0", "JG_HALF_PI_1")
"""Double also where numbers are float."""

CONSTANTS: dict[str, dict[str, float]] = {
    "double": {
        "JG_SINE_0": -0.1666666666666662,
        "JG_SINE_1": 0.00833333333331984,
        "JG_SINE_2": -0.00019841269827728817,
        "JG_SINE_3": 2.7557312965201385e-06,
        "JG_SINE_4": -2.505064362971169e-08,
        "JG_SINE_5": 1.589012699342121e-10,
        "JG_COSINE_0": 0.041666666666666574,
        "JG_COSINE_1": -0.0013888888888869803,
        "JG_COSINE_2": 2.4801587286801603e-05,
        "JG_COSINE_3": -2.755731358277366e-07,
        "JG_COSINE_4": 2.0875619294176904e-09,
        "JG_COSINE_5": -1.1354295585288413e-11,
        "JG_ARC_0": -0.3333333333333298,
        "JG_ARC_1": 0.19999999999903162,
        "JG_ARC_2": -0.14285714276390032,
        "JG_ARC_3": 0.11111110659798236,
        "JG_ARC_4": -0.09090896248386567,
        "JG_ARC_5": 0.07692073964330842,
        "JG_ARC_6": -0.06663811099367613,
        "JG_ARC_7": 0.05858301913919141,
        "JG_ARC_8": -0.051220181066562946,
        "JG_ARC_9": 0.041865364369077444,
        "JG_ARC_10": -0.02743543153020035,
        "JG_ARC_11": 0.010117164395310239,
        "JG_HALF_PI_0": 1.5707963267923333,
        "JG_HALF_PI_1": 2.5633441515839558e-12,
        "JG_HALF_PI_2": 1.0562999066944068e-23,
        "JG_HALF_PI_3": 4.3359050650618903e-35,
        "JG_EIGHTH_TURN": 0.7853981633974483,
        "JG_EIGHTH_TURN_REST": 3.061616997868383e-17,
        "JG_QUARTERS_PER_RADIAN": 0.6366197723675814,
    },
    "float": {
        "JG_SINE_0": -0.16666653752326965,
        "JG_SINE_1": 0.008332070894539356,
        "JG_SINE_2": -0.0001950306905200705,
        "JG_COSINE_0": 0.04166664183139801,
        "JG_COSINE_1": -0.0013887194218114018,
        "JG_COSINE_2": 2.4419196051894687e-05,
        "JG_ARC_0": -0.3333323299884796,
        "JG_ARC_1": 0.19994226098060608,
        "JG_ARC_2": -0.14175011217594147,
        "JG_ARC_3": 0.10160017013549805,
        "JG_ARC_4": -0.05132600665092468,
        "JG_HALF_PI_0": 1.5707963267923333,
        "JG_HALF_PI_1": 2.5633441515839558e-12,
        "JG_EIGHTH_TURN": 0.785398006439209,
        "JG_EIGHTH_TURN_REST": 1.5695823663008923e-07,
        "JG_QUARTERS_PER_RADIAN": 0.6366197466850281,
    },
}
"""By number type: name in C -> value."""


def definitions(real: str) -> list[tuple[str, str]]:
    """Names and literals of the constants for a number type."""
    return [(name, repr(value) if name in _WIDE else f"JG_REAL({value!r})") for name, value in CONSTANTS[real].items()]
