"""The catalogue of joints: S1 Table 1 (conventional), Table 5 (parametric, planar corrected), the 16 trn x rot pairs.

A new joint is one entry here; everything else follows from it.
"""

from __future__ import annotations

from codegen.spec.joints import Dot1, Dot2, JointType, Screw, Spherical

_SCREW_PARAMETERS = (("pitch", "m/rad"), ("theta_0", "rad"), ("revolutions", "1"))

JOINTS: dict[str, JointType] = {
    joint.name: joint
    for joint in (
        JointType("revolute", 1, (Spherical(), Dot1("f", "h"), Dot1("g", "h")), 0, 1),
        JointType("translational", 1, (Dot1("f", "h"), Dot1("g", "h"), Dot1("f", "g"), Dot2("f"), Dot2("g")), 1, 0),
        JointType(
            "screw",
            1,
            (Dot2("f"), Dot2("g"), Dot1("f", "h"), Dot1("g", "h"), Screw()),
            1,
            1,
            is_screw=True,
            parameters=_SCREW_PARAMETERS,
        ),
        JointType("cylindrical", 2, (Dot2("f"), Dot2("g"), Dot1("f", "h"), Dot1("g", "h")), 1, 1),
        JointType("universal", 2, (Spherical(), Dot1("h", "h")), 0, 2),
        JointType("planar", 3, (Dot1("f", "h"), Dot1("g", "h"), Dot2("h")), 2, 1),
        JointType("ball", 3, (Spherical(),), 0, 3),
        JointType("rigid", 0, (Spherical(), Dot1("f", "h"), Dot1("g", "h"), Dot1("f", "g")), 0, 0),
    )
}
"""The joint library, in the order of the papers."""

BASIC: dict[str, JointType] = {
    "dot-1": JointType("dot_1", 5, (Dot1("f", "h"),), 0, 0),
    "dot-2": JointType("dot_2", 5, (Dot2("f"),), 0, 0),
    "spherical": JointType("spherical", 3, (Spherical(),), 0, 0),
    "screw": JointType("screw_alone", 5, (Screw(),), 0, 0, is_screw=True, parameters=_SCREW_PARAMETERS),
}
"""The basic constraints alone, under their names in S1 Table 2; conventional form only."""

PAIRS: dict[str, JointType] = {
    f"trn{k}_rot{n}": JointType(f"trn{k}_rot{n}", k + n, (), k, n) for k in range(4) for n in range(4)
}
"""All pairs of a translational and a rotational constraint (S1 Table 3), parametric form only."""
