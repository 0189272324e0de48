"""Rows, rank and degrees of freedom of mechanisms whose mobility is known."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import sympy
from sympy.polys.matrices import DomainMatrix

from codegen.ir.evaluate import evaluate, fraction_domain
from codegen.measure.constraints import Pose
from codegen.measure.mobility import Mobility, Verdict, mobility
from codegen.measure.mobility_text import as_data, lines
from tests.measure.mechanisms import (
    Drawing,
    about_z,
    bars_that_are_too_short,
    bennett,
    bennett_bodies,
    bricard,
    dense,
    four_bar,
    parallelogram_with_a_third_crank,
    pendulum,
    polygon,
    program,
    shaky_arm,
    slider_crank,
    spatial_slider_crank,
    triangle,
    two_bars_in_line,
)

FORMS = (("conventional", ""), ("parametric", "regular"))
each_form = pytest.mark.parametrize(("form", "rows"), FORMS)


def judged(drawing: Drawing, form: str = "conventional", rows: str = "regular") -> Mobility:
    return mobility(*drawing.mechanism(form, rows))


def verdict(found: Mobility) -> Verdict:
    (part,) = found.parts
    assert part.verdict is not None
    return part.verdict


def turned(drawing: Drawing, rotation: np.ndarray, shift: np.ndarray) -> Drawing:
    """The same mechanism elsewhere."""
    bodies = {name: (rotation @ r + shift, rotation @ A) for name, (r, A) in drawing.bodies.items()}
    joints = [
        replace(
            joint,
            point=rotation @ np.array(joint.point, float) + shift,
            axis=rotation @ np.array(joint.axis),
            second=None if joint.second is None else rotation @ np.array(joint.second),
        )
        for joint in drawing.joints
    ]
    return Drawing(bodies, joints)


class TestTheInLineSliderCrank:
    def test_has_20_rows_of_rank_17_and_one_freedom(self):
        found = judged(slider_crank())
        assert (found.rows, found.columns, found.rank, found.freedoms) == (20, 18, 17, 1)

    def test_loses_the_rows_of_one_joint_that_hold_it_in_the_plane(self):
        # f of the cylinder is y, g is z: g_i . h_j and f_i . g_j hold the tilts, g_i . d_ij the height over the plane.
        found = judged(slider_crank())
        assert found.redundant == (("cylinder", "g_i . h_j"), ("cylinder", "f_i . g_j"), ("cylinder", "g_i . d_ij"))

    def test_keeps_rows_that_are_independent_in_exact_arithmetic(self):
        matrix = exact_slider_crank()
        kept = judged(slider_crank()).kept
        assert (matrix.shape, matrix.rank()) == ((20, 18), 17)
        assert matrix.extract(list(kept), list(range(18))).rank() == len(kept) == 17

    def test_is_regular_at_dead_centre(self):
        found = verdict(judged(slider_crank(angle=0.0)))
        assert (found.rank, found.freedoms, found.is_singular) == (17, 1, False)

    def test_with_a_rod_as_long_as_the_crank_is_singular_where_the_piston_crosses_the_main_bearing(self):
        found = judged(slider_crank(0.4, 0.4, np.pi / 2))
        assert verdict(found).is_singular
        assert (verdict(found).ranks[0].rank, found.rank, found.freedoms) == (16, 17, 1)
        assert any("singular configuration: at the given pose the rank is 16" in line for line in lines(found))

    def test_with_a_rod_as_long_as_the_crank_is_regular_elsewhere(self):
        found = verdict(judged(slider_crank(0.4, 0.4, 0.7)))
        assert (found.rank, found.is_singular, found.freedoms) == (17, False, 1)

    def test_is_the_same_where_the_pose_is_given_to_five_digits(self):
        system, pose = slider_crank().mechanism()
        rounded = replace(pose, r=np.round(pose.r, 5))
        assert np.max(np.abs(system.phi(rounded))) > 1e-6
        assert mobility(system, rounded).redundant == mobility(system, pose).redundant

    @pytest.mark.parametrize("unit", [1e-3, 1e3])
    def test_is_the_same_in_other_units(self, unit):
        assert judged(slider_crank(unit=unit)).redundant == judged(slider_crank()).redundant
        assert judged(slider_crank(unit=unit)).freedoms == 1

    def test_is_the_same_mechanism_in_a_tilted_plane(self):
        rotation = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
        rotation = rotation * np.linalg.det(rotation)
        found = judged(turned(slider_crank(), rotation, np.array([0.3, -2.0, 5.0])))
        assert (found.rows, found.rank, found.freedoms, len(found.redundant)) == (20, 17, 1, 3)
        assert verdict(found).by_dimensions == 0

    @pytest.mark.parametrize("rows", ["regular", "table4"])
    def test_has_one_freedom_in_the_parametric_form_too(self, rows):
        drawing = slider_crank()
        found = judged(drawing, "parametric", rows)
        assert (found.rows, found.columns, found.freedoms) == (24, 22, 1)
        assert found.rank == 21

    def test_loses_rank_with_the_rows_of_the_paper_where_all_angles_are_zero(self):
        # SPEC S1.2: from 21 to 18 in the reference pose, at dead centre.
        found = verdict(judged(slider_crank(angle=0.0), "parametric", "table4"))
        assert (found.ranks[0].rank, found.rank, found.is_singular) == (18, 21, True)


def exact_slider_crank() -> "RationalMatrix":
    """phi_q of the slider-crank with crank 5/8 and rod 13/10 at cos = 3/5, in rationals."""
    q = Fraction
    crank_pin, piston = (q(3, 8), q(1, 2), q(0)), (q(3, 8) + q(6, 5), q(0), q(0))
    zero = (q(0), q(0), q(0))
    identity = sympy.eye(3)
    bodies = {
        None: (zero, identity),
        "crank": (tuple(x / 2 for x in crank_pin), rational_turn(q(3, 5), q(4, 5))),
        "rod": (
            tuple((a + b) / 2 for a, b in zip(crank_pin, piston, strict=True)),
            rational_turn(q(12, 13), q(-5, 13)),
        ),
        "piston": (piston, identity),
    }
    z_frame, x_frame = identity, sympy.Matrix([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    joints = (
        ("revolute", None, "crank", zero, z_frame),
        ("revolute", "crank", "rod", crank_pin, z_frame),
        ("revolute", "rod", "piston", piston, z_frame),
        ("translational", None, "piston", piston, x_frame),
    )
    names = list(bodies)[1:]
    blocks = []
    for kind, i, j, point, frame in joints:
        block = sympy.Matrix(exact_block(kind, bodies[i], bodies[j], point, frame))
        row = sympy.zeros(5, 18)
        for body, columns in ((i, block[:, :6]), (j, block[:, 6:])):
            if body:
                row[:, 6 * names.index(body) : 6 * names.index(body) + 6] += columns
        blocks.append(row)
    return RationalMatrix(sympy.Matrix.vstack(*blocks))


class RationalMatrix:
    """A matrix of rationals with a quick exact rank."""

    def __init__(self, matrix):
        self.matrix, self.shape = matrix, matrix.shape

    def rank(self) -> int:
        return DomainMatrix.from_Matrix(self.matrix).to_field().rank()

    def extract(self, rows, columns):
        return RationalMatrix(self.matrix.extract(rows, columns))


def rational_turn(c: Fraction, s: Fraction) -> sympy.Matrix:
    c, s = sympy.Rational(c.numerator, c.denominator), sympy.Rational(s.numerator, s.denominator)
    return sympy.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def exact_block(kind, body_i, body_j, point, frame):
    """phi_q of one joint by its generic routine, evaluated in rationals."""
    inputs, geometry = {}, []
    for end, (r, A) in (("i", body_i), ("j", body_j)):
        offset = A.T * sympy.Matrix([sympy.Rational(p - x) for p, x in zip(point, r, strict=True)])
        geometry += [*offset, *(A.T * frame).T]
        inputs |= {f"r_{end}": list(r), f"A_{end}": [Fraction(int(x.p), int(x.q)) for x in A.T]}
    inputs["geometry"] = [Fraction(int(x.p), int(x.q)) for x in geometry]
    generic = program(kind, "conventional", "")
    values = evaluate(generic, inputs, fraction_domain())["phi_q"]
    return dense(
        generic, [sympy.Rational(value.numerator, value.denominator) for value in values], sympy.S.Zero
    ).tolist()


class TestKnownMechanisms:
    """Degrees of freedom from textbooks: Gruebler in the plane, Bricard 1897, Haug 1989."""

    @each_form
    def test_a_pendulum_has_one_freedom(self, form, rows):
        found = judged(pendulum(), form, rows)
        assert (found.freedoms, found.redundant, found.rows) == (1, (), found.rank)

    @each_form
    def test_a_four_bar_has_one_freedom_and_three_redundant_rows_from_plane_motion(self, form, rows):
        found = judged(four_bar(), form, rows)
        assert (found.freedoms, len(found.redundant)) == (1, 3)
        assert [group.name for group in verdict(found).groups] == ["plane motion"]
        assert verdict(found).by_dimensions == 0

    @each_form
    def test_a_third_parallel_crank_adds_a_row_that_its_length_makes_redundant(self, form, rows):
        # Two plane loops, 3 each; in the plane 4 bodies less 6 pins leave 12 - 12 = 0, yet it moves: one more.
        found = judged(parallelogram_with_a_third_crank(), form, rows)
        assert (found.freedoms, len(found.redundant), verdict(found).by_dimensions) == (1, 7, 1)
        assert any("overconstrained, and mobile only as long as" in line for line in lines(found))

    @each_form
    def test_a_third_crank_of_another_length_locks_it(self, form, rows):
        drawing = parallelogram_with_a_third_crank()
        foot = np.array([2.1, -0.1, 0.0])
        drawing.bar("crank 2", foot, np.array([2.2, 0.5, 0.0]))
        drawing.joints = [replace(joint, point=foot) if joint.name == "foot 2" else joint for joint in drawing.joints]
        found = judged(drawing, form, rows)
        assert (found.freedoms, len(found.redundant), verdict(found).infinitesimal) == (0, 6, 0)
        assert any("locked" in line for line in lines(found))

    @each_form
    def test_bricards_six_bar_moves_by_its_dimensions_alone(self, form, rows):
        found = judged(bricard(), form, rows)
        assert (found.freedoms, len(found.redundant), verdict(found).by_dimensions) == (1, 1, 1)
        assert [group.dimension for group in verdict(found).groups] == [6]
        assert not verdict(found).is_singular

    def test_rows_kept_of_bennetts_linkage_are_independent_all_the_way_round(self):
        system, pose = bennett(1.2).mechanism()
        kept = list(mobility(system, pose).kept)
        assert len(kept) == 17
        for angle in np.radians(np.arange(0.5, 360.0, 3.0)):
            bodies = bennett_bodies(float(angle)).values()
            there = Pose(np.array([r for r, _ in bodies]), np.array([A for _, A in bodies]), np.zeros(0))
            phi, phi_q = system.values(there)
            assert np.max(np.abs(phi)) < 1e-12
            every, own = (np.linalg.svd(rows, compute_uv=False) for rows in (phi_q, phi_q[kept]))
            assert own[-1] > 0.03 * every[16]

    @each_form
    def test_a_spherical_four_bar_has_one_freedom_and_three_redundant_rows(self, form, rows):
        axes = ((0, 0, 1), (0.8, 0, 0.6), (0.6, 0.64, 0.48), (0, 0.8, 0.6))
        drawing = Drawing()
        for k in range(3):
            drawing.body(f"link {k}", (np.array(axes[k]) + np.array(axes[k + 1])) / 2, about_z(float(k)))
        names = [None, "link 0", "link 1", "link 2", None]
        for k, axis in enumerate(axes):
            drawing.joint(f"hinge {k}", "revolute", (names[k], names[k + 1]), axis, axis)
        found = judged(drawing, form, rows)
        assert (found.freedoms, len(found.redundant), verdict(found).groups[0].name) == (1, 3, "spherical motion")

    @each_form
    def test_a_spatial_slider_crank_has_one_freedom_and_no_redundant_row(self, form, rows):
        found = judged(spatial_slider_crank(), form, rows)
        assert (found.freedoms, found.redundant, verdict(found).suggestions) == (1, (), ())

    @each_form
    def test_a_rod_between_two_balls_spins_besides(self, form, rows):
        found = judged(spatial_slider_crank("ball"), form, rows)
        assert (found.freedoms, found.redundant) == (2, ())

    @each_form
    def test_a_triangle_of_bars_is_locked(self, form, rows):
        found = judged(triangle(), form, rows)
        assert (found.freedoms, len(found.redundant), verdict(found).infinitesimal) == (0, 3, 0)
        assert any("locked" in line for line in lines(found))

    @each_form
    def test_two_bars_in_line_are_shaky_and_no_row_that_holds_them_is_dropped(self, form, rows):
        found = judged(two_bars_in_line(), form, rows)
        assert (found.freedoms, verdict(found).infinitesimal, len(found.redundant)) == (0, 1, 3)
        assert any("shaky" in line for line in lines(found))

    @each_form
    def test_a_shaky_part_of_a_mechanism_that_moves_is_told_from_its_motion(self, form, rows):
        found = judged(shaky_arm(), form, rows)
        assert (found.freedoms, verdict(found).infinitesimal, len(found.redundant)) == (1, 1, 3)
        assert not verdict(found).is_singular

    def test_a_welded_body_adds_no_freedom(self):
        drawing = pendulum()
        drawing.body("bob", (0.7, -0.9, 0.1))
        drawing.joint("weld", "rigid", ("bar", "bob"), (0.6, -0.8, 0), (0.6, 0.0, 0.8))
        assert (judged(drawing).freedoms, judged(drawing).redundant) == (1, ())

    def test_a_parallelogram_is_singular_where_it_is_flat(self):
        points = {"O1": (0, 0, 0), "A": (0.5, 0, 0), "B": (1.5, 0, 0), "O2": (1, 0, 0)}
        flat = polygon(points, {"crank": ("O1", "A"), "coupler": ("A", "B"), "rocker": ("B", "O2")})
        found = verdict(judged(flat))
        assert (found.ranks[0].rank, found.rank, found.is_singular, found.freedoms) == (16, 17, True, 1)

    def test_a_screw_jack_has_one_freedom(self):
        # A nut that turns in its bearing lifts a spindle that cannot turn.
        drawing = Drawing()
        drawing.body("nut", (0, 0, 0.1))
        drawing.body("spindle", (0, 0, 0.3))
        drawing.joint("bearing", "revolute", (None, "nut"), (0, 0, 0.1))
        drawing.joint("thread", "screw", ("nut", "spindle"), (0, 0, 0.1), pitch=0.01)
        drawing.joint("guide", "translational", (None, "spindle"), (0, 0, 0.3))
        found = judged(drawing)
        assert found.freedoms == 1
        # Bodies on one axis: 3 rows each hold tilts and offsets twice, less those that the nut needs.
        assert found.rows - found.rank == len(found.redundant) == 15 - (12 - 1)

    def test_a_free_body_has_six_freedoms(self):
        drawing = pendulum()
        drawing.body("stone", (1, 2, 3))
        found = judged(drawing)
        assert (found.freedoms, len(found.parts)) == (7, 2)


class TestSuggestions:
    @pytest.mark.parametrize("drawing", [slider_crank(), four_bar(), triangle(), bricard()])
    def test_leave_a_mechanism_that_moves_as_before_without_redundant_rows(self, drawing):
        found = judged(drawing)
        suggested = verdict(found).suggestions
        assert suggested
        for suggestion in suggested:
            assert suggestion.left == 0
            other = Drawing(drawing.bodies, list(drawing.joints))
            for change in suggestion.replacements:
                other.joints[change.joint] = replace(other.joints[change.joint], type=change.new)
            after = judged(other)
            assert (after.redundant, after.freedoms, after.rows) == ((), found.freedoms, after.rank)

    def test_name_the_joints(self):
        text = "\n".join(lines(judged(bricard())))
        assert 'to avoid it: cylindrical instead of revolute at joint "hinge 0"' in text

    def test_say_what_remains_where_no_freer_joint_helps(self):
        (suggestion,) = verdict(judged(parallelogram_with_a_third_crank())).suggestions
        assert suggestion.left == 1
        assert all(change.new == "ball" for change in suggestion.replacements)


class TestSeveralParts:
    def test_equal_ones_are_judged_once_and_reported_together(self):
        found = judged(slider_crank(copies=20))
        assert (found.rows, found.columns, found.rank, found.freedoms) == (400, 360, 340, 20)
        assert len({id(part.verdict) for part in found.parts}) == 1
        assert ("cylinder 20", "g_i . d_ij") in found.redundant
        assert sum("equal parts" in line for line in lines(found)) == 1

    def test_equal_ones_are_judged_as_each_alone(self):
        alone, many = judged(slider_crank()), judged(slider_crank(copies=3))
        assert many.kept == tuple(20 * copy + row for copy in range(3) for row in alone.kept)

    def test_different_ones_are_told_apart(self):
        drawing, other = slider_crank(), pendulum()
        drawing.bodies |= other.bodies
        drawing.joints = other.joints + drawing.joints
        found = judged(drawing)
        assert [part.bodies for part in found.parts] == [("crank", "rod", "piston"), ("bar",)]
        assert (found.freedoms, len(found.redundant)) == (2, 3)
        assert found.kept[:5] == (0, 1, 2, 3, 4)

    def test_a_part_that_does_not_close_is_named_with_its_gaps(self):
        drawing, other = bars_that_are_too_short(), pendulum()
        drawing.bodies |= other.bodies
        drawing.joints += [replace(joint, name="pivot") for joint in other.joints]
        found = judged(drawing)
        assert (found.is_closed, found.freedoms) == (False, 1)
        assert "part of left, right does not close:" in lines(found)
        assert as_data(found)["parts"][0]["closes"] is False


class TestTheReport:
    def test_is_data_for_json(self):
        data = json.loads(json.dumps(as_data(judged(slider_crank()))))
        assert (data["rows"], data["rank"], data["dof"]) == (20, 17, 1)
        assert {"joint": "cylinder", "row": "g_i . d_ij"} in data["dropped_rows"]

    def test_is_the_same_in_every_run(self):
        assert lines(judged(slider_crank())) == lines(judged(slider_crank()))

    def test_states_tolerance_and_distance_of_the_singular_values(self):
        text = "\n".join(lines(judged(slider_crank())))
        assert "tolerance 1e-07" in text
        assert "the others are below 1e-12" in text
