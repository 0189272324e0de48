"""Runs at and beyond the limits of what a chain can do: they are told, not papered over."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest

from codegen.chains.position import nearest
from codegen.chains.start import coordinates, start
from codegen.errors import SpecificationError
from codegen.spec.chain import Chain, Frame
from codegen.spec.chain_motions import Harmonic, Independent, Polynomial
from tests.reference import quick_return as planar
from tests.reference import spatial_slider_crank as spatial

from .mechanisms import PI, RIGHT, four_bar, quick_return, row, spatial_slider_crank, three_cranks
from .runs import by_table, prescribed_run

LOCK = F(str(spatial.lock_up().evalf(30)))
X = -1
ABOUT = np.linspace(0.0, 0.2, 9)
"""The crank passes where it would lock at 0.1106 s."""


@pytest.mark.parametrize("above", [F("1e-3"), F("1e-6")])
def test_just_above_lock_up_the_crank_turns_over_on_its_branch(above: F) -> None:
    length = LOCK + above
    run = prescribed_run(by_table(spatial_slider_crank(length)), ABOUT, is_inverse=False)
    reference = spatial.spatial_slider_crank(length)
    assert not run.failure
    for state in run.states:
        x, v, _ = reference.output("x", state.q[0] + float(RIGHT), state.qd[0])
        assert abs(state.q[X] - x) < 1e-10
        assert abs(state.qd[X] - v) < 1e-8


def test_below_lock_up_there_is_no_solution_and_the_nearest_pose_is_told() -> None:
    run = prescribed_run(by_table(spatial_slider_crank(LOCK - F("1e-4"))), ABOUT)
    assert "between t = 0.1 s and 0.125 s: no solution" in run.failure
    assert 'the nearest pose leaves cut "guide"' in run.failure
    assert "last closed pose: crank" in run.failure
    assert len(run.states) == 5
    assert float(run.states[-1].q[X]) > 0


def test_the_nearest_pose_is_as_far_open_as_the_rod_is_too_short() -> None:
    """Where the crank points along the offset the rod lies across the slide: what lacks is lock-up less its length."""
    angle = float(np.arctan2(0.1, 0.12))
    ready = by_table(spatial_slider_crank(LOCK - F("1e-4"), q=angle))
    found = nearest(ready.equations, ready.part, coordinates(ready))
    phi = ready.equations.closure(found.q).p[0]
    assert not found.is_closed
    assert 0.5e-4 < np.linalg.norm(phi) < 1.001e-4  # some of it is taken up by turning


def test_a_start_beyond_lock_up_is_refused_with_the_nearest_pose() -> None:
    angle = float(np.arctan2(0.1, 0.12))
    ready = by_table(spatial_slider_crank(LOCK - F("1e-4"), q=angle))
    with pytest.raises(SpecificationError, match="no solution; the nearest pose leaves"):
        start(ready, np.array([angle - float(RIGHT)]))


def refusal(chain: Chain) -> str:
    ready = by_table(chain)
    with pytest.raises(SpecificationError) as caught:
        start(ready, coordinates(ready)[ready.part.v])
    return str(caught.value)


def test_too_many_independent_coordinates_are_told_where_they_open_the_cuts() -> None:
    chain = four_bar()
    links = tuple(replace(one, row=row(a=2, theta=F("0.8"))) if one.name == "crank 2" else one for one in chain.links)
    told = refusal(replace(chain, links=links, independents=(*chain.independents, Independent("crank 2"))))
    assert told.startswith("independent: ") and "name 1 independent coordinates" in told and "instead of 2" in told


def test_an_independent_coordinate_out_of_reach_is_told_with_a_pose_in_reach() -> None:
    chain = four_bar(angle=3.0)
    (cut,) = chain.cuts
    told = refusal(replace(chain, cuts=(replace(cut, base=Frame("coupler", row(a=F("1.2")))),)))
    assert told.startswith("independent: ") and "with these free too the cuts close at crank 1 " in told


def test_at_lock_up_branches_meet_and_the_run_stops_with_the_pose() -> None:
    run = prescribed_run(by_table(spatial_slider_crank(LOCK)), ABOUT)
    assert "bifurcation" in run.failure or "singular pose" in run.failure
    assert run.states[-1].t == pytest.approx(0.1)


def test_a_cut_that_is_turned_by_half_a_turn_at_the_start_is_closed() -> None:
    """The quaternion's e_0 is 0 there."""
    chain = quick_return()
    links = tuple(replace(link, prefer=link.row.theta + PI) if link.name == "pivot" else link for link in chain.links)
    ready = by_table(replace(chain, links=links))
    turned = ready.equations.closure(coordinates(ready)).R[0]
    assert np.trace(turned) == pytest.approx(-1.0, abs=1e-12)
    here = start(ready, np.array([planar.START]))
    assert here.q[X] == pytest.approx(planar.quick_return().output("x", planar.START, 1.0)[0], abs=1e-10)


def test_a_misfit_of_1e_6_that_no_coordinate_closes_is_told() -> None:
    """Out of the plane: the row is structurally zero."""
    chain = quick_return()
    cut = chain.cuts[0]
    off = replace(cut, base=replace(cut.base, row=replace(cut.base.row, c=F("1e-6"))))
    with pytest.raises(
        SpecificationError, match=r'cut "rocker bearing": z is open by 1e-06 m, and no coordinate moves'
    ):
        start(by_table(replace(chain, cuts=(off, chain.cuts[1]))), np.array([planar.START]))


def test_a_misfit_of_1e_6_in_an_over_determined_loop_is_told() -> None:
    """The third crank of a parallelogram is too far away."""
    ready = by_table(three_cranks(misfit=F("1e-6")))
    with pytest.raises(SpecificationError, match="no solution; the nearest pose leaves cut"):
        start(ready, np.array([0.7]))


def test_cuts_that_are_open_with_the_coordinates_of_the_file_are_refused_with_their_gaps() -> None:
    chain = quick_return()
    links = tuple(
        replace(link, row=replace(link.row, theta=link.row.theta + F("0.01"))) if link.name == "slider" else link
        for link in chain.links
    )
    with pytest.raises(SpecificationError, match=r'cut "guide": is open by .* m and 0.57295. degrees') as told:
        start(by_table(replace(chain, links=links)), np.array([planar.START]))
    assert len(told.value.mistakes) == 1
    here = start(by_table(replace(chain, links=links, assemble=True)), np.array([planar.START]))
    assert here.q[X] == pytest.approx(planar.quick_return().output("x", planar.START, 1.0)[0], abs=1e-10)


def test_millimetres_and_metres_give_the_same_motion_and_reactions() -> None:
    """Forces are in N either way: mass times mm/s^2 is mN."""
    by_metre = prescribed_run(by_table(spatial_slider_crank()), ABOUT)
    by_millimetre = prescribed_run(by_table(spatial_slider_crank(scale=1000)), ABOUT)
    assert [s.t for s in by_metre.states] == [s.t for s in by_millimetre.states]
    assert by_metre.iterations == by_millimetre.iterations
    for one, other in zip(by_metre.states, by_millimetre.states, strict=True):
        assert one.loads is not None and other.loads is not None
        units = np.array([1, 1, 1, 1, 1, 1, 1000.0])
        assert one.q * units == pytest.approx(other.q, rel=1e-11, abs=1e-11)
        assert one.qdd * units == pytest.approx(other.qdd, rel=1e-9, abs=1e-8)
        assert one.loads.tau[0] * 1e6 == pytest.approx(other.loads.tau[0], rel=1e-9, abs=1e-6)
        turned = one.loads.reaction * np.repeat([1e3, 1e6], 3)
        assert turned == pytest.approx(other.loads.reaction, rel=1e-9, abs=1e-6)
        assert one.least == pytest.approx(other.least, rel=1e-9)


@pytest.mark.parametrize("side", [1, -1])
def test_both_branches_are_reached_by_a_preference_and_kept(side: int) -> None:
    """The same file but for the preferred coordinates, approximate ones."""
    other = spatial_slider_crank(branch=side)
    rough = {link.name: F(round(float(link.coordinate), 1)) for link in other.links}
    chain = spatial_slider_crank()
    links = tuple(replace(link, prefer=rough[link.name]) for link in chain.links)
    run = prescribed_run(by_table(replace(chain, links=links)), np.linspace(0.0, 1.0, 21), is_inverse=False)
    reference = spatial.spatial_slider_crank(F("0.27"), side)
    assert not run.failure
    for state in run.states:
        assert abs(state.q[X] - reference.output("x", state.q[0] + float(RIGHT), 1.0)[0]) < 1e-10


def test_angles_keep_their_turns() -> None:
    run = prescribed_run(by_table(quick_return(w=20 * PI)), np.linspace(0.0, 0.2, 5), is_inverse=False)
    assert run.states[-1].q[0] == pytest.approx(planar.START + 4 * np.pi)
    others = [state.q[1] + state.q[0] for state in run.states]  # the rocker's angle: it swings
    assert np.ptp(others) < 2.0


def test_a_parallelogram_with_three_cranks_moves_and_its_cut_reactions_are_marked() -> None:
    ready = by_table(three_cranks())
    here = start(ready, np.array([0.7]))
    assert len(ready.part.rows) == len(ready.part.w) + 1
    assert here.factor.undetermined().shape == (len(ready.part.rows), 1)
    assert here.q[ready.chain.index("crank 2")] == pytest.approx(0.7, abs=1e-12)


def test_a_parallelogram_stops_where_it_lies_flat() -> None:
    """It could go on as a parallelogram or as an antiparallelogram."""
    ready = by_table(four_bar(Polynomial((F("0.5"), F(4)))))
    run = prescribed_run(ready, np.linspace(0.0, 1.0, 21), is_inverse=False)
    assert "bifurcation: branches of the motion meet at the pose" in run.failure
    last = float(run.failure.split("crank 1 ")[1].split()[0])
    assert last == pytest.approx(np.pi, abs=1e-6)


def test_a_start_in_a_bifurcation_is_refused_with_what_is_free() -> None:
    ready = by_table(four_bar(Polynomial((F(0),)), angle=0.0))
    with pytest.raises(SpecificationError, match=r"the pose at t = 0 is singular: rank .* free to move besides: "):
        start(ready, np.array([0.0]))


def test_independent_coordinates_that_do_not_determine_the_others_are_refused() -> None:
    """At the end of its stroke the slider does not determine the crank."""
    end = float(np.arctan2(0.1, 0.12))
    chain = spatial_slider_crank(q=end)
    chain = replace(chain, independents=(Independent("slide"),))
    ready = by_table(chain)
    with pytest.raises(SpecificationError, match="choose other independent coordinates"):
        start(ready, coordinates(ready)[-1:])


def test_a_motion_that_turns_back_comes_back() -> None:
    motion = Harmonic(F("0.44"), F("0.8"), 2 * PI, F(0))
    chain = replace(quick_return(), independents=(Independent("crank", motion),))
    run = prescribed_run(by_table(chain), np.linspace(0.0, 1.0, 9), is_inverse=False)
    assert run.states[-1].q == pytest.approx(run.states[0].q, abs=1e-10)
    assert run.states[4].q == pytest.approx(run.states[0].q, abs=1e-10)


def test_far_outputs_are_reached_on_the_same_branch_as_near_ones() -> None:
    ready = by_table(spatial_slider_crank(F("0.24")))
    far = prescribed_run(ready, np.array([0.0, 0.7]), is_inverse=False)
    near = prescribed_run(ready, np.linspace(0.0, 0.7, 29), is_inverse=False)
    assert far.states[-1].q == pytest.approx(near.states[-1].q, abs=1e-10)


def test_a_mechanism_far_from_the_base_runs_to_the_rounding_of_its_distance() -> None:
    """1 km away; the crank's axis and the guide are moved together."""
    chain = spatial_slider_crank()
    away = F(1000)
    crank = replace(chain.links[0], row=replace(chain.links[0].row, a=chain.links[0].row.a + away))
    cut = chain.cuts[0]
    base = replace(cut.base, row=replace(cut.base.row, a=cut.base.row.a + away))
    far = replace(chain, links=(crank, *chain.links[1:]), cuts=(replace(cut, base=base),))
    run = prescribed_run(by_table(far), ABOUT, is_inverse=False)
    reference = spatial.spatial_slider_crank(F("0.27"))
    assert not run.failure
    for state in run.states:
        assert abs(state.q[X] - reference.output("x", state.q[0] + float(RIGHT), 1.0)[0]) < 1e-11
