"""The package of the routine that a budget chose."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from codegen import build
from codegen.errors import InternalError
from codegen.measure.routine_builds import Build
from codegen.scenes.generate import generate_scene
from codegen.spec.request import QUANTITIES, Options
from codegen.trade.domain_checks import joint_check, scene_check
from codegen.trade.judgement import Judgement
from codegen.trade.requests import AccuracyRequest, Request, SceneRequest


def chosen_build(request: Request, judgement: Judgement) -> Build:
    """The build of a candidate."""
    return next(build for build in request.builds() if build.name == judgement.build)


def chosen_real(request: Request, judgement: Judgement) -> str:
    """The number type of a candidate."""
    return chosen_build(request, judgement).real


def chosen_files(request: Request, judgement: Judgement) -> dict[str, bytes]:
    """Generate the package of a candidate: path -> content.

    Where ``JG_ASSERT_DOMAIN`` is defined its routines assert that their inputs are in the domain.
    """
    if isinstance(request, SceneRequest):
        names = QUANTITIES if request.output == "all" else (request.output,)
        scene = replace(request.scene, wanted=replace(request.scene.wanted, quantities=names))
        form = judgement.routine.partition(" --form ")[2]
        real = chosen_real(request, judgement)
        return generate_scene(scene, form or None, real, check=partial(scene_check, request.domain, real))
    if not isinstance(request, AccuracyRequest):
        raise InternalError("a request that nothing is generated for")
    options = _options(request, judgement)
    return build.generate(options, check=partial(joint_check, request.domain, options.real))


def _options(request: AccuracyRequest, judgement: Judgement) -> Options:
    """The request that generates the package of a candidate."""
    choice = chosen_build(request, judgement)
    found = (v for v in request.variants() if judgement.routine.startswith(v.routine_stem(request.output)))
    variant = max(found, key=lambda variant: len(variant.stem))
    return Options(
        (variant.joint,),
        variant.form,
        variant.rows,
        variant.derivative,
        variant.variation,
        real=choice.real,
        outputs=(request.output,),
        batch=choice.lanes if choice.lanes > 1 else None,
        fma=choice.fma,
    )
