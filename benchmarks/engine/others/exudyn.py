"""Exudyn: rigid bodies with Euler parameters and generic joints, integrated by the generalised alpha method."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

import numpy as np

from codegen.measure.constraints import Array
from codegen.spec.scene import Scene

exudyn: Any = importlib.import_module("exudyn")
utilities: Any = importlib.import_module("exudyn.utilities")

SETTINGS = tuple(1.0 / steps for steps in (500, 1000, 2000, 5000, 5400, 6000, 10000, 20000, 50000))
"""Steps, s."""

_FIXED = {
    "main bearing": ((None, 0), (0.0, 0.0, 0.0), (1, 1, 1, 1, 1, 0)),
    "crank pin": ((0, 1), (0.1, 0.0, 0.0), (1, 1, 1, 1, 1, 0)),
    "piston pin": ((1, 2), (0.4, 0.0, 0.0), (1, 1, 0, 0, 0, 0)),
    "cylinder": ((None, 2), (0.4, 0.0, 0.0), (0, 1, 1, 1, 1, 1)),
}
"""Joint -> bodies (None: ground), point in the world, axes that are held; redundant ones are left out."""


def ready(scene: Scene, sets: int, outputs: int) -> Callable[[float], Array]:
    """Prepare a run of 1 s."""
    systems: dict[float, tuple[Any, Any, list[Any]]] = {}

    def run(step: float) -> Array:
        if step not in systems:
            systems[step] = _system(scene, sets, step, outputs)
        mbs, settings, bodies = systems[step]
        mbs.SolveDynamic(settings)
        start = np.array([[float(x) for x in body.position[:2]] for body in scene.bodies])
        if not outputs:
            return start[None]
        stored = [np.array(mbs.GetSensorStoredData(sensor))[:, 1:3] for sensor in bodies]
        return np.stack(stored, axis=1)

    return run


def _system(scene: Scene, sets: int, step: float, outputs: int) -> tuple[Any, Any, list[Any]]:
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.CreateGround()
    sensors: list[Any] = []
    for n in range(sets):
        shift = np.array([0.0, 0.0, 0.1 * n])
        bodies = [_body(mbs, scene, k, shift) for k in range(3)]
        for (i, j), point, axes in _FIXED.values():
            pair = [ground if i is None else bodies[i], bodies[j]]
            mbs.CreateGenericJoint(
                bodyNumbers=pair, position=list(shift + point), constrainedAxes=list(axes), show=False
            )
        if not sensors and outputs:
            sensors = [_sensor(mbs, body) for body in bodies]
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = round(1.0 / step), 1.0
    integration.generalizedAlpha.spectralRadius = 0.9
    integration.newton.useModifiedNewton = True
    integration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 1.0 / max(1, outputs)
    settings.linearSolverType = exudyn.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    return mbs, settings, sensors


def _sensor(mbs: Any, body: Any) -> Any:
    kind = exudyn.OutputVariableType.Position
    return mbs.AddSensor(utilities.SensorBody(bodyNumber=body, storeInternal=True, outputVariableType=kind))


def _body(mbs: Any, scene: Scene, k: int, shift: Array) -> Any:
    body = scene.bodies[k]
    inertia = utilities.RigidBodyInertia(float(body.mass), np.array(body.inertia, dtype=np.float64))
    return mbs.CreateRigidBody(
        inertia=inertia,
        referencePosition=list(shift + np.array(body.position, dtype=np.float64)),
        initialVelocity=[float(x) for x in body.velocity],
        initialAngularVelocity=[float(x) for x in body.angular_velocity],
        gravity=[float(x) for x in scene.gravity],
        show=False,
    )
