"""MuJoCo: a tree of hinges, the rod and the piston tied by an equality constraint, which is soft."""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np

from codegen.measure.constraints import Array
from codegen.spec.scene import Scene

SETTINGS = tuple(
    1.0 / steps for steps in (200, 500, 560, 600, 700, 1000, 2000, 5000, 10000, 20000, 50000, 100000, 200000)
)
"""Steps, s. The tie is as stiff as the step allows."""

_ENGINE = """
<body name="crank{n}" pos="0.05 0 {z}">
  <joint type="hinge" axis="0 0 1" pos="-0.05 0 0"/>
  <inertial pos="0 0 0" mass="1.2" diaginertia="0.0102 0.0111 0.0211"/>
  <body name="rod{n}" pos="0.2 0 0">
    <joint type="hinge" axis="0 0 1" pos="-0.15 0 0"/>
    <inertial pos="0 0 0" mass="0.8" diaginertia="0.0001 0.0061 0.0061"/>
  </body>
</body>
<body name="piston{n}" pos="0.4 0 {z}">
  <joint type="slide" axis="1 0 0"/>
  <inertial pos="0 0 0" mass="0.5" diaginertia="0.0004 0.0003 0.0003"/>
</body>
"""
_TIE = '<connect body1="rod{n}" body2="piston{n}" anchor="0.15 0 0" solref="{time} 1" solimp="0.9999 0.9999 0.001"/>'


def ready(scene: Scene, sets: int, outputs: int) -> Callable[[float], Array]:
    """Prepare a run of 1 s."""
    models: dict[float, tuple[mujoco.MjModel, mujoco.MjData]] = {}

    def run(step: float) -> Array:
        if step not in models:
            model = mujoco.MjModel.from_xml_string(_model(scene, sets, step))
            models[step] = model, mujoco.MjData(model)
        model, data = models[step]
        mujoco.mj_resetData(model, data)
        data.qvel[:] = np.tile([15.0, -20.0, 0.0], sets)
        mujoco.mj_forward(model, data)
        found = [data.xipos[1:4, :2].copy()]
        for _ in range(outputs):
            mujoco.mj_step(model, data, round(1.0 / step / outputs))
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            found.append(data.xipos[1:4, :2].copy())
        return np.array(found)

    return run


def _model(scene: Scene, sets: int, step: float) -> str:
    bodies = "".join(_ENGINE.format(n=n, z=0.1 * n) for n in range(sets))
    ties = "".join(_TIE.format(n=n, time=2 * step) for n in range(sets))
    gravity = " ".join(f"{float(g):g}" for g in scene.gravity)
    return f"""<mujoco>
<compiler inertiafromgeom="false" angle="radian"/>
<option timestep="{step}" gravity="{gravity}" integrator="RK4" tolerance="1e-14" iterations="200"/>
<worldbody>{bodies}</worldbody>
<equality>{ties}</equality>
</mujoco>"""
