"""Models of MuJoCo (MJCF), as scenes in the initial pose ``qpos0``.

MuJoCo itself reads the file, with its classes of defaults, included files and units, and gives doubles. A number is the
shortest decimal of its double: the one in the file, where MuJoCo takes it over as it is and it has up to 15 digits.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import REMEDY, Imported, ImportOptions, LeftOut
from codegen.spec.link_tree import assembled
from codegen.spec.mjcf_left_out import left_out
from codegen.spec.mjcf_mechanism import missing_meshes, reduce_to_mechanism
from codegen.spec.mjcf_text import parts_of
from codegen.spec.mjcf_tree import link_tree


def read_mjcf(
    text: str | bytes, place: str, options: ImportOptions | None = None, files: Mapping[str, bytes] | None = None
) -> Imported:
    """Read a model.

    Args:
        text: the file.
        place: its name, for messages.
        options: how it is read; ``free_base`` has no meaning here.
        files: what it may include, and meshes that inertias follow from, by their path beside it. No other file is
            opened.

    Returns:
        The scene. The axes of a body are those of the body of the model.

    Raises:
        SpecificationError: with what MuJoCo finds first, or with all that a scene cannot take.
    """
    parts = parts_of(text, place, files or {})
    specification, model, warned = _compiled(text, place, files or {}, set(parts))
    tree = link_tree(specification, model, place, options or ImportOptions())
    listed = (item for part, root in parts.items() for item in left_out(root, part))
    return assembled(replace(tree, left_out=(*listed, *tree.left_out, *warned)))


def _compiled(
    text: str | bytes, place: str, files: Mapping[str, bytes], included: set[str]
) -> tuple[Any, Any, list[LeftOut]]:
    """The specification without what a scene does not need, the model of it, and what MuJoCo warns of."""
    try:
        import mujoco
    except ImportError:
        what = "models of MuJoCo are read with mujoco, which is not installed"
        raise SpecificationError([Mistake(place, what, REMEDY)]) from None
    parts = {name: content for name, content in files.items() if name in included}
    assets = {name: content for name, content in files.items() if name not in included}
    previous, told = mujoco.get_mju_user_warning(), list[str]()
    mujoco.set_mju_user_warning(told.append)  # otherwise a log is written into the current folder
    try:
        written = text if isinstance(text, str) else text.decode()
        specification = mujoco.MjSpec.from_string(written, include=parts, assets=assets)
        reduce_to_mechanism(specification, mujoco)
        missing = missing_meshes(specification, files, place)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            model = None if missing else specification.compile()
    except (ValueError, TypeError, MemoryError, mujoco.FatalError) as error:
        what = " ".join(str(error).split())
        raise SpecificationError([Mistake(place, f"MuJoCo refuses it: {what}", _remedy(what))]) from None
    finally:
        mujoco.set_mju_user_warning(previous)
    if missing:
        raise SpecificationError(missing)
    told += [str(warning.message) for warning in caught]
    return specification, model, [LeftOut("warning", place, f"MuJoCo says: {' '.join(what.split())}") for what in told]


def _remedy(what: str) -> str:
    if "mjMINVAL" in what:
        return "give every body that moves a mass and an inertia, those between two joints too"
    return "correct it; MuJoCo must be able to load it"
