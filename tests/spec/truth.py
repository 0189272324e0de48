"""Scenes against MuJoCo, which reads the same text by itself."""

from __future__ import annotations

import numpy as np

from codegen.spec.scene import Scene
from tests.spec.mechanism import AXES, Tree, attitude, floats

TOLERANCE = 1e-12


def loaded(text: str):
    import mujoco

    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def same_bodies(scene: Scene, model, data, poses) -> None:
    """Mass, centre of mass and inertia about it in world axes."""
    names = {body.name for body in scene.bodies}
    assert names == {model.body(k).name for k in range(1, model.nbody) if model.body_weldid[k] == k and k}
    for body in scene.bodies:
        theirs = data.body(body.name)
        r, A = poses[body.name]
        ours = A @ floats(body.inertia) @ A.T
        R = theirs.ximat.reshape(3, 3)
        inertia = R @ np.diag(model.body(body.name).inertia) @ R.T
        assert abs(float(body.mass) - model.body(body.name).mass[0]) <= TOLERANCE * float(body.mass)
        np.testing.assert_allclose(r, theirs.xipos, rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(ours, inertia, rtol=0, atol=TOLERANCE * np.abs(inertia).max())
        np.testing.assert_allclose(A, theirs.xmat.reshape(3, 3), rtol=0, atol=TOLERANCE)


def same_at_start(scene: Scene, model, data) -> None:
    same_bodies(scene, model, data, Tree(scene).poses)
    for body in scene.bodies:
        r, A = Tree(scene).poses[body.name]
        np.testing.assert_allclose(r, floats(body.position), rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(A, attitude(body), rtol=0, atol=TOLERANCE)


def same_in_motion(scene: Scene, model, data, stacks: dict[str, list[str]], generator) -> None:
    """Poses and the mass matrix at random coordinates.

    Args:
        scene: ours.
        model: theirs.
        data: theirs, changed.
        stacks: for each of our joints the joints of MuJoCo that its coordinates are, in our order.
        generator: of random numbers.
    """
    import mujoco

    values = {joint.name: list(generator.uniform(-1.5, 1.5, len(AXES[joint.type]))) for joint in scene.joints}
    dofs = []
    for joint in scene.joints:
        for name, value in zip(stacks.get(joint.name, [joint.name]), values[joint.name], strict=True):
            data.qpos[model.joint(name).qposadr[0]] = model.qpos0[model.joint(name).qposadr[0]] + value
            dofs.append(model.joint(name).dofadr[0])
    mujoco.mj_forward(model, data)
    tree = Tree(scene, values)
    same_bodies(scene, model, data, tree.poses)
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    ours = tree.mass_matrix()
    np.testing.assert_allclose(ours, M[np.ix_(dofs, dofs)], rtol=0, atol=TOLERANCE * np.abs(M).max())
