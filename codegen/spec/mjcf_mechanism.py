"""Takes out of a specification of MuJoCo what has no part in its mechanism, so that no file is needed for it."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from typing import Any

from codegen.errors import Mistake
from codegen.spec.imported import quoted

_UNUSED = ("keys", "sensors", "actuators", "tendons", "excludes", "pairs", "skins", "lights", "cameras")
"""Each before what it may refer to."""

_SIZES = ("memory", "njmax", "nconmax", "nstack", "nuserdata", "nkey")


def reduce_to_mechanism(specification: Any, mujoco: Any) -> None:
    """Leave bodies, joints, what closes loops, and the shapes that inertias follow from."""
    loops = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)
    for equality in [equality for equality in specification.equalities if equality.type not in loops]:
        specification.delete(equality)
    for kind in _UNUSED:
        for item in list(getattr(specification, kind)):
            specification.delete(item)
    for geom in [geom for geom in specification.geoms if not _has_mass(geom, specification, mujoco)]:
        specification.delete(geom)
    for item in (*specification.geoms, *specification.sites):
        item.material = ""
    shaping = {geom.meshname for geom in specification.geoms}
    unused = [mesh for mesh in specification.meshes if mesh.name not in shaping]
    for item in (*specification.hfields, *specification.materials, *specification.textures, *unused):
        specification.delete(item)
    for size in _SIZES:
        setattr(specification, size, 0 if size in ("nuserdata", "nkey") else -1)


def missing_meshes(specification: Any, files: Mapping[str, bytes], place: str) -> list[Mistake]:
    """Meshes that an inertia follows from and that are not given."""
    mistakes = []
    for mesh in specification.meshes:
        name = posixpath.basename(mesh.file) if specification.strippath else mesh.file
        if mesh.file and posixpath.join(specification.meshdir, name) not in files:
            what = "an inertia follows from it, and it is missing"
            remedy = "put it beside the model, or give the body an <inertial>"
            mistakes.append(Mistake(f"{place}: mesh {quoted(mesh.file)}", what, remedy))
    return mistakes


def _has_mass(geom: Any, specification: Any, mujoco: Any) -> bool:
    """Whether the inertia of a body may follow from a shape."""
    shapeless = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
    if geom.type in shapeless or geom.parent.name == "world":
        return False
    source = specification.compiler.inertiafromgeom
    if source == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_AUTO:
        return not geom.parent.explicitinertial
    return bool(source == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE)
