"""A design whose worst condition number over a workspace is least, found by IPOPT through the emitted function."""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.platforms.design import design_function
from codegen.platforms.hexagons import hexagons
from codegen.platforms.programs import program

from .geometries import SEMI_REGULAR

POSES = [
    (np.array([x, y, z]), Rotation.from_euler("ZYX", [yaw, 0, 0]).as_matrix())
    for x, y, z in ((0, 0, 0), (0.1, 0, 0), (-0.1, 0.05, 0.1), (0, -0.1, -0.1))
    for yaw in (0.0, 0.15)
]
SIGMA, GAMMA = 0, 3


def worst(top: Any, delta: Any, height: Any) -> Any:
    """The worst C of sigma and gamma over the poses, of many designs at once: by the program, without CasADi."""
    base, joints = hexagons(top, delta)
    smooth = program(SEMI_REGULAR.platform("smooth"), ("C",), is_symbolic=True)
    greatest = np.zeros_like(top)
    for o, R in POSES:
        inputs = {
            "o": [o[0] + 0 * top, o[1] + 0 * top, o[2] + height],
            "R": [R[i, k] + 0 * top for k in range(3) for i in range(3)],
            "base": [base[i, leg] for leg in range(6) for i in range(3)],
            "platform": [joints[i, leg] for leg in range(6) for i in range(3)],
        }
        C = evaluate(smooth, inputs, numpy_domain())["C"]
        greatest = np.maximum(greatest, np.maximum(C[SIGMA], C[GAMMA]))
    return greatest


def optimum(start: list[float]) -> Any:
    """Top radius, angle, height and worst index of the best design."""
    top, delta, height, bound = (casadi.MX.sym(name) for name in ("top", "delta", "height", "bound"))
    sides, pairs = [-1, 1] * 3, [0, 0, 1, 1, 2, 2]
    angles = [
        [2 * np.pi / 3 * k + side * apart for k, side in zip(pairs, sides, strict=True)] for apart in (0.3, 0.3 + delta)
    ]
    base, joints = (
        casadi.horzcat(*(casadi.vertcat(r * casadi.cos(a), r * casadi.sin(a), 0) for a in of))
        for r, of in ((1.0, angles[0]), (top, angles[1]))
    )
    C = design_function(SEMI_REGULAR.platform(), "C")
    limits = []
    for o, R in POSES:
        values = C(casadi.DM(o) + casadi.vertcat(0, 0, height), R, base, joints)
        limits += [values[SIGMA] - bound, values[GAMMA] - bound]
    problem = {"x": casadi.vertcat(top, delta, height, bound), "f": bound, "g": casadi.vertcat(*limits)}
    options = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
    solver = casadi.nlpsol("solver", "ipopt", problem, options)
    found = solver(x0=start, lbx=[0.2, 0.1, 0.2, 1], ubx=[1, 3, 3, 100], ubg=0)
    assert solver.stats()["success"]
    return np.array(found["x"]).ravel()


def test_no_other_design_is_better_than_that_of_ipopt() -> None:
    top, delta, height, bound = optimum([0.6, 0.8, 1.0, 5.0])
    one = np.ones(1)
    assert worst(top * one, delta * one, height * one)[0] == pytest.approx(bound, rel=1e-6)
    assert bound < worst(0.6 * one, 0.8 * one, 1.0 * one)[0]
    generator = np.random.default_rng(2)
    near = [x + generator.uniform(-0.1, 0.1, 500) for x in (top, delta, height)]
    near[0] = np.clip(near[0], 0.2, 1)
    wide = [generator.uniform(low, high, 3000) for low, high in ((0.2, 1), (0.1, 3), (0.2, 3))]
    for designs in (near, wide):
        assert worst(*designs).min() >= bound * (1 - 1e-6)


def test_the_function_of_pose_and_joints_has_finite_derivatives_at_home() -> None:
    """Values are repeated there; the derivative of the textbook's form would be NaN."""
    C = design_function(SEMI_REGULAR.platform(), "C")
    symbols = [casadi.SX.sym(C.name_in(k), C.sparsity_in(k)) for k in range(C.n_in())]
    J = casadi.Function("J", symbols, [casadi.jacobian(C(*symbols), casadi.vertcat(*map(casadi.vec, symbols)))])
    value = J(np.array([0, 0, 0.9]), np.eye(3), SEMI_REGULAR.base, SEMI_REGULAR.joints)
    assert np.isfinite(np.array(value)).all()
