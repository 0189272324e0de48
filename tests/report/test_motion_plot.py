"""The plot of a run shows what moves, to scale, with units, the same bytes every time."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from codegen.report.motion_plot import plot, thinned
from codegen.report.motion_rows import joint_rows
from codegen.simulate.trajectory import Trajectory, columns
from codegen.spec.scene import Coordinate, Drive

from .runs import engine, tumbling

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def drawing() -> str:
    scene, trajectory = engine()
    return plot(trajectory, "in_line_engine", scene)


def curves(svg: str) -> dict[str, np.ndarray]:
    """Id of each curve -> its vertices [n, 2] in the drawing."""
    found = {}
    for group in ElementTree.fromstring(svg).iter(f"{SVG}g"):
        path = group.find(f"{SVG}path")
        if path is not None and "." in group.get("id", ""):
            numbers = re.findall(r"-?[\d.]+", path.get("d"))
            found[group.get("id")] = np.array(numbers, dtype=float).reshape(-1, 2)
    return found


def texts(svg: str) -> list[str]:
    return [element.text for element in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def without_motion(trajectory: Trajectory) -> Trajectory:
    still = {name: np.zeros_like(trajectory.v) for name in ("v", "w", "a", "al")}
    r = np.broadcast_to(trajectory.r[:1], trajectory.r.shape)
    return replace(trajectory, r=r, **still, alpha={}, alphadot={}, effort={}, reaction={})


def test_each_component_that_moves_has_its_curve_and_no_other_has(drawing):
    expected = {
        *(f"{body}.{name}{axis}" for body in ("crank", "rod") for name in "rva" for axis in "xy"),
        *(f"{body}.{name}z" for body in ("crank", "rod") for name in ("w", "al")),
        *(f"piston.{name}x" for name in "rva"),
        *(f"{joint}.{name}1" for joint in ("main bearing", "cylinder") for name in ("alpha", "alphadot")),
        "main bearing.effort",
    }
    assert set(curves(drawing)) == expected


def test_curves_are_the_columns_of_the_trajectory_to_scale(drawing):
    _, trajectory = engine()
    table = dict(columns(trajectory))
    table |= {f"{joint}.alphadot1": rate[:, 0] for joint, rate in trajectory.alphadot.items()}
    drawn = curves(drawing)
    constant = {"crank.wz", "crank.alz", "main bearing.alphadot1"}
    for name, path in drawn.items():
        values = table[name]
        assert len(path) == len(trajectory.t)
        axes = [(path[:, 0], trajectory.t), *([] if name in constant else [(-path[:, 1], values)])]
        for axis, truth in axes:
            scaled = (axis - axis.min()) / np.ptp(axis)
            assert np.allclose(scaled, (truth - truth.min()) / np.ptp(truth), atol=1e-5), name
    for name in constant:
        assert np.ptp(drawn[name][:, 1]) < 1e-3, f"{name} differs in its last digits only, and is no noise that fills"


def test_curves_of_a_panel_have_one_scale(drawing):
    _, trajectory = engine()
    x, y = (curves(drawing)[f"crank.r{axis}"] for axis in "xy")
    assert np.ptp(x[:, 1]) / np.ptp(y[:, 1]) == pytest.approx(
        np.ptp(trajectory.r[:, 0, 0]) / np.ptp(trajectory.r[:, 0, 1]), rel=1e-4
    )


def test_the_axes_have_units(drawing):
    words = texts(drawing)
    for unit in ("m", "m/s", "m/s²", "rad", "rad/s", "rad/s²", "N m", "t in s"):
        assert unit in words


def test_without_a_scene_the_unit_of_a_coordinate_is_left_open():
    words = texts(plot(engine()[1], "engine"))
    assert "m or rad" in words
    assert "m/s or rad/s" in words
    assert "N or N m" in words


def test_lines_differ_without_colour(drawing):
    styles = {}
    for group in ElementTree.fromstring(drawing).iter(f"{SVG}g"):
        if group.get("id") in ("crank.rx", "crank.ry", "crank.wz"):
            dashes = re.search(r"stroke-dasharray: ([^;]*)", group.find(f"{SVG}path").get("style"))
            styles[group.get("id")] = dashes and dashes[1]
    assert len(set(styles.values())) == 3


def test_a_joint_with_coordinates_of_two_units_has_a_row_for_each():
    scene, trajectory = tumbling()
    rows = joint_rows(trajectory, scene)
    found = [(row.name, panel.unit, len(panel.curves)) for row in rows for panel in [row.panels["coordinate"]]]
    assert ("one cylindrical", "m", 1) in found
    assert ("one cylindrical", "rad", 1) in found
    assert ("one planar", "m", 2) in found
    assert ("one planar", "rad", 1) in found
    assert ("one ball", "rad", 3) in found
    assert not any(name == "one rigid" for name, _, _ in found)


def test_an_effort_stands_in_the_row_of_its_coordinate():
    scene, trajectory = tumbling()
    cylindrical = next(joint for joint in scene.joints if joint.type == "cylindrical")
    turned = replace(cylindrical, coordinates=(Coordinate(), Coordinate(drive=Drive(Fraction(0), Fraction(1)))))
    effort = {cylindrical.name: trajectory.t[:, None]}
    alpha = {cylindrical.name: trajectory.alpha[cylindrical.name]}
    rows = joint_rows(replace(trajectory, alpha=alpha, effort=effort, reaction={}), replace(scene, joints=(turned,)))
    assert [panel.unit for panel in rows[0].panels.values()] == ["m", "m/s"]
    assert [panel.unit for panel in rows[1].panels.values()] == ["rad", "rad/s", "N m"]


def test_reactions_that_act_stand_in_the_first_row_of_their_joint():
    scene, trajectory = tumbling()
    count = len(trajectory.t)
    wave = np.sin(trajectory.t)
    acting = np.zeros((count, 6))
    acting[:, 0], acting[:, 5] = wave, 1e-12 * wave
    turning = np.zeros((count, 6))
    turning[:, 4] = wave
    reaction = {"one cylindrical": acting, "one rigid": turning}
    rows = joint_rows(replace(trajectory, reaction=reaction), scene)
    found = [
        (row.name, heading, panel.unit, [name for name, _, _ in panel.curves])
        for row in rows
        for heading, panel in row.panels.items()
        if heading.startswith("reaction")
    ]
    assert found == [
        ("one cylindrical", "reaction force", "N", ["one cylindrical.fx"]),
        ("one rigid", "reaction moment", "N m", ["one rigid.my"]),
    ]
    assert [row.name for row in rows].count("one cylindrical") == 2


def test_of_many_bodies_eight_are_drawn_and_a_note_tells_of_the_others():
    names = tuple(f"body {k}" for k in range(11))
    _, trajectory = tumbling(names=names)
    svg = plot(replace(trajectory, alpha={}, alphadot={}), "many")
    assert {name.split(".")[0] for name in curves(svg)} == set(names[:8])
    assert any("first 8 of 11 moving bodies" in word for word in texts(svg))


def test_a_run_without_motion_is_drawn_too():
    svg = plot(without_motion(engine()[1]), "rest")
    assert not curves(svg)
    assert any("3 of 3 bodies do not" in word for word in texts(svg))


def test_a_run_of_one_time_is_drawn_too():
    _, trajectory = engine(2)
    first = {n: getattr(trajectory, n)[:1] for n in ("t", "r", "q", "v", "w", "a", "al")}
    ElementTree.fromstring(plot(replace(trajectory, **first, alpha={}, alphadot={}, effort={}, reaction={}), "start"))


def test_hostile_names_stay_text():
    name = '</g><script>$\\frac{"&'
    _, trajectory = tumbling(names=(name,))
    svg = plot(trajectory, name)
    assert name in texts(svg)
    assert not list(ElementTree.fromstring(svg).iter(f"{SVG}script"))


def test_thinned_curves_keep_their_ends_and_extremes():
    values = np.sin(np.linspace(0, 40, 50_001))
    values[31_234] = 5.0
    kept = thinned(values)
    assert len(kept) <= 1202
    assert {0, 50_000, 31_234, int(np.argmin(values))} <= set(kept.tolist())


def test_the_bytes_are_the_same_twice(drawing):
    scene, trajectory = engine()
    assert plot(trajectory, "in_line_engine", scene) == drawing
