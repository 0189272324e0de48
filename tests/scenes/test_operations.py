"""Operations of the in-line slider-crank: three revolute joints and a slide; phi, phi_q and the second derivative.

Operations are those of `flopcount.count`; the pairs of sine and cosine are counted apart. The figures are those of a
prototype; they are met or beaten.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from codegen.mechanics.assembly import Assembly
from codegen.scenes.programs import program, without_zero_rows
from codegen.spec.plane import flattened
from codegen.spec.request import Variant
from codegen.spec.scene import ZERO_VECTOR, Joint, Scene
from flopcount.count import count
from flopcount.counts import Counts
from tests.spec.texts import EXAMPLES, scene

NAMES = ("phi", "phi_q", "phi_q_t_lambda_q")
ENGINE = next(path for path in EXAMPLES if path.stem == "in_line_engine")


def slider_crank() -> Scene:
    """The example; its slide starts at 0 where the piston is at t = 0."""
    return scene(ENGINE.read_text())


def counted(mechanism: Scene, form: str, rows: str | None = None, derivative: str = "exact") -> Counts:
    """Operations of the cheapest program found; in the plane without the rows that vanish."""
    forms = {joint.name: Variant(joint.type, form, rows, derivative) for joint in mechanism.joints}
    assembly = Assembly(mechanism, forms)
    return count(program(without_zero_rows(assembly) if mechanism.motion == "planar" else assembly, NAMES))


def from_the_origin(joint: Joint) -> Joint:
    """A slide along x with its points at the centre of mass and at the origin: its coordinate is the position."""
    if joint.type != "translational":
        return joint
    return replace(
        joint,
        marker_i=replace(joint.marker_i, point=ZERO_VECTOR),
        marker_j=replace(joint.marker_j, point=ZERO_VECTOR),
    )


def test_in_space_the_conventional_form_takes_at_most_263_operations() -> None:
    assert counted(slider_crank(), "conventional").total <= 263


def test_in_the_plane_the_conventional_form_takes_at_most_27_operations() -> None:
    assert counted(flattened(slider_crank()), "conventional").total <= 27


@pytest.mark.parametrize(("rows", "figure"), (("table4", 131), ("regular", 160)))
def test_with_the_derivative_substituted_the_parametric_form_takes_at_most_the_figure(rows: str, figure: int) -> None:
    """The prototype's slide was measured from the origin; from the piston at t = 0 there is one subtraction more."""
    for figure_of, joint_of in ((figure, from_the_origin), (figure + 1, lambda joint: joint)):
        mechanism = slider_crank()
        mechanism = replace(mechanism, joints=tuple(map(joint_of, mechanism.joints)))
        found = counted(mechanism, "parametric", rows, "substituted")
        assert found.sincos == 3
        assert found.total - found.sincos <= figure_of


def test_a_joint_at_the_centres_of_mass_takes_one_subtraction_for_a_row() -> None:
    """Axes that are those of the bodies, and attachments that are zero, take no operation."""
    mechanism = flattened(slider_crank())
    pin = mechanism.joints[1]
    pin = replace(
        pin, marker_i=replace(pin.marker_i, point=ZERO_VECTOR), marker_j=replace(pin.marker_j, point=ZERO_VECTOR)
    )
    assembly = Assembly(replace(mechanism, joints=(pin,)), {pin.name: Variant("revolute", "conventional", None)})
    found = count(program(without_zero_rows(assembly), ("phi", "phi_q")))
    assert (found.total, found.add) == (2, 2)
