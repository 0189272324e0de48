"""What the manifest says of a scene as a whole: bodies, joints, rows, displacements and the state of an integrator."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from codegen.emit.scene_subject import SceneSubject


def scene_record(subject: SceneSubject) -> dict[str, Any]:
    """Describe a scene; names are those of its file, identifiers those in the names of parts."""
    assembly = subject.assembly
    kept = set(assembly.rows)
    names = [{"joint": joint, "row": row} for joint, row in subject.row_names]
    drives = [{"joint": driven.joint, "row": "drive"} for driven in subject.system.drives]
    return {
        "name": assembly.scene.name,
        "motion": assembly.scene.motion,
        "bodies": [{"name": body.name, "identifier": assembly.bodies[body.name]} for body in assembly.scene.bodies],
        "joints": [
            {
                "name": placed.joint.name,
                "identifier": placed.ends.name,
                "type": placed.joint.type,
                "bodies": list(placed.joint.bodies),
                "form": assembly.forms[placed.joint.name].form,
                "rows": assembly.forms[placed.joint.name].rows,
                "derivative": assembly.forms[placed.joint.name].derivative,
            }
            for placed in assembly.placed
        ],
        "rows": [name for row, name in enumerate(names) if row in kept] + drives,
        "left_out": [name for row, name in enumerate(names) if row not in kept],
        "displacements": [
            {"name": name, "offset": offset, "size": shape[0], "meaning": meaning}
            for name, offset, shape, meaning in replace(subject, plan=None).displacements("delta")
        ],
        "state": [
            {"name": name, "unit": unit} for name, unit in zip(subject.state.names, subject.state.units, strict=True)
        ],
    }
