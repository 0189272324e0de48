"""The constraints of a scene from the routines of the joint library, put into place here.

Each joint is evaluated by the library's routine for run-time geometry, between its two bodies. The library's parametric
routines have translations ``delta r' = A^T delta r``; a scene has world translations, or ``delta r'`` in all joints
where a derivative is substituted. Numbers may be of any type that the routines can be evaluated over.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.program import Output, Program
from codegen.mechanics.assembly import Assembly
from codegen.models import model
from codegen.spec.markers import markers
from codegen.spec.request import QUANTITIES, Variant
from codegen.spec.scene import GROUND, Joint, Marker
from tests.lower.numbers import Numbers, skew

Arrays = Mapping[str, Sequence[Any]]


@cache
def routine(variant: Variant) -> Program:
    """The library's routine of all quantities."""
    return model(variant).program(QUANTITIES)


def dense(output: Output, values: Sequence[Any], zero: Any) -> Numbers:
    """An output as a matrix."""
    matrix = np.full((output.sparsity.nrow, output.sparsity.ncol), zero, dtype=object)
    for (row, column), value in zip(output.sparsity.entries(), values, strict=True):
        matrix[row, column] = value
    return matrix


@dataclass(frozen=True)
class System:
    """Inputs of a scene in space, by body and joint.

    Attributes:
        assembly: the scene.
        inputs: arguments of its routines.
        number: makes a number of an exact one.
    """

    assembly: Assembly
    inputs: Arrays
    number: Callable[[Any], Any]

    def position(self, body: int) -> Numbers:
        """[3], world."""
        return self._vector("r", 3 * body) if body >= 0 else self._still()

    def attitude(self, body: int) -> Numbers:
        """[3, 3], body to world."""
        if body >= 0:
            return self._array(self.inputs["A"][9 * body : 9 * body + 9]).reshape(3, 3).T
        return self._array([self.number(int(k % 4 == 0)) for k in range(9)]).reshape(3, 3)

    def velocity(self, body: int) -> tuple[Numbers, Numbers]:
        """Of the centre of mass, world axes, and angular, body axes."""
        if body < 0:
            return self._still(), self._still()
        v, omega = self._vector("velocity", 6 * body), self._vector("velocity", 6 * body + 3)
        return (self.attitude(body) @ v if self.assembly.translations == "body" else v), omega

    def alpha(self, joint: int) -> slice:
        """Where the coordinates of a joint are among those of all."""
        counts = [coordinates_of(self.assembly.forms[j.name]) for j in self.assembly.scene.joints]
        return slice(sum(counts[:joint]), sum(counts[: joint + 1]))

    def rows(self, joint: int) -> slice:
        """Where the rows of a joint are among those of all."""
        counts = [rows_of(self.assembly.forms[j.name]) for j in self.assembly.scene.joints]
        return slice(sum(counts[:joint]), sum(counts[: joint + 1]))

    def multipliers(self) -> list[Any]:
        """Of all rows; zero where a row is left out."""
        kept = iter(self.inputs["lambda"])
        rows = self.rows(len(self.assembly.scene.joints) - 1).stop
        return [self.number(0) if row in self.assembly.dropped else next(kept) for row in range(rows)]

    def turns(self, joint: int) -> Any:
        """Whole turns of a joint: counted for conventional screws."""
        counting = [
            j.name
            for j in self.assembly.scene.joints
            if j.type == "screw" and self.assembly.forms[j.name].form == "conventional"
        ]
        name = self.assembly.scene.joints[joint].name
        return self.inputs["revolutions"][counting.index(name)] if name in counting else self.number(0)

    def geometry(self, joint: int) -> list[Any]:
        """Geometry of a joint as the library has it."""
        data = self.assembly.scene.joints[joint]
        exact = [x for marker in markers(data, self.assembly.forms[data.name].form) for x in _laid(marker)]
        values = [self.number(x) for x in exact]
        return [*values, self.number(data.pitch), self.number(0), self.turns(joint)] if data.type == "screw" else values

    def numbers(self, joint: Joint) -> tuple[int, int]:
        """Of the bodies of a joint; -1 for the ground."""
        names = [body.name for body in self.assembly.scene.bodies]
        i, j = (-1 if name == GROUND else names.index(name) for name in joint.bodies)
        return i, j

    def _still(self) -> Numbers:
        return self._array([self.number(0)] * 3)

    def _vector(self, name: str, first: int) -> Numbers:
        return self._array(self.inputs[name][first : first + 3])

    def _array(self, values: Sequence[Any]) -> Numbers:
        found = np.empty(len(values), dtype=object)
        found[:] = values
        return found


def coordinates_of(variant: Variant) -> int:
    """Joint coordinates of a form."""
    return next((a.length for a in routine(variant).arguments if a.name == "alpha"), 0)


def rows_of(variant: Variant) -> int:
    """Rows of a form."""
    return next(a.length for a in routine(variant).arguments if a.name == "lambda")


def _laid(marker: Marker) -> list[Any]:
    return [*marker.point, *(x for column in zip(*marker.axes, strict=True) for x in column)]


def assembled(system: System, domain: Domain) -> dict[str, Numbers]:
    """Quantities of the constraints, dense, with the rows of the scene.

    ``phi_q v`` and ``phi_q^T lambda`` are products of the assembled Jacobian.
    """
    assembly, zero = system.assembly, system.number(0)
    bodies = len(assembly.scene.bodies)
    multipliers = system.multipliers()
    size, rows = 6 * bodies + len(system.inputs["alpha"]), len(multipliers)
    phi, gamma = np.full((rows, 1), zero, dtype=object), np.full((rows, 1), zero, dtype=object)
    phi_q, second = np.full((rows, size), zero, dtype=object), np.full((size, size), zero, dtype=object)
    for number in range(len(assembly.scene.joints)):
        found = _of_joint(system, number, multipliers, domain)
        here = system.rows(number)
        phi[here], gamma[here] = found["phi"], found["gamma"]
        columns = _columns(system, number)
        for k, column in enumerate(columns):
            if column is None:
                continue
            phi_q[here, column] += found["phi_q"][:, k]
            for m, row in enumerate(columns):
                if row is not None:
                    second[row, column] += found["phi_q_t_lambda_q"][m, k]
    velocity, forces = np.array(system.inputs["velocity"], dtype=object), np.array(multipliers, dtype=object)
    kept = list(assembly.rows)
    return {
        "phi": phi[kept],
        "phi_q": phi_q[kept],
        "phi_q_t_lambda_q": second,
        "gamma": gamma[kept],
        "phi_q_v": (phi_q @ velocity)[kept, None],
        "phi_q_t_lambda": (phi_q.T @ forces)[:, None],
    }


def _columns(system: System, joint: int) -> list[int | None]:
    i, j = system.numbers(system.assembly.scene.joints[joint])
    alpha = system.alpha(joint)
    first = 6 * len(system.assembly.scene.bodies)
    moving = [6 * body + k if body >= 0 else None for body in (i, j) for k in range(6)]
    return [*moving, *range(first + alpha.start, first + alpha.stop)]


def _of_joint(system: System, number: int, multipliers: list[Any], domain: Domain) -> dict[str, Numbers]:
    assembly = system.assembly
    joint = assembly.scene.joints[number]
    variant = assembly.forms[joint.name]
    bodies = system.numbers(joint)
    program, alpha, here = routine(variant), system.alpha(number), system.rows(number)
    attitudes = [system.attitude(body) for body in bodies]
    velocity: list[Any] = []
    for body, A in zip(bodies, attitudes, strict=True):
        v, omega = system.velocity(body)
        velocity += [*(A.T @ v if variant.translations == "body" else v), *omega]
    rates = system.inputs["velocity"][6 * len(assembly.scene.bodies) :]
    inputs = {
        "r_i": list(system.position(bodies[0])),
        "A_i": list(attitudes[0].T.ravel()),
        "r_j": list(system.position(bodies[1])),
        "A_j": list(attitudes[1].T.ravel()),
        "alpha": list(system.inputs["alpha"][alpha]),
        "geometry": system.geometry(number),
        "velocity": velocity + list(rates[alpha]),
        "lambda": multipliers[here],
    }
    values = evaluate(program, inputs, domain)
    found = {output.name: dense(output, values[output.name], system.number(0)) for output in program.outputs}
    for k, A in enumerate(attitudes):
        if variant.translations != assembly.translations:
            _turn(found, 6 * k, A, multipliers[here], assembly.translations)
    return found


def _turn(found: dict[str, Numbers], first: int, A: Numbers, multipliers: Sequence[Any], translations: str) -> None:
    """Write the translations of a body in other axes, ``delta r' = A^T delta r``; those of the body turn with it.

    Of a force F' in body axes ``delta (A F') = A (delta F' + delta pi~ F')``, of a force F in world axes
    ``delta (A^T F) = A^T delta F - delta pi~ A^T F``.

    Args:
        found: quantities of a joint, changed in place.
        first: column of the body.
        A: attitude of the body.
        multipliers: of the rows of the joint.
        translations: the axes there will be.
    """
    moves, turns = slice(first, first + 3), slice(first + 3, first + 6)
    phi_q, second = found["phi_q"], found["phi_q_t_lambda_q"]
    force = phi_q[:, moves].T @ np.array(multipliers, dtype=object)
    to = A if translations == "world" else A.T
    phi_q[:, moves] = phi_q[:, moves] @ to.T
    second[moves] = to @ second[moves]
    second[:, moves] = second[:, moves] @ to.T
    second[moves, turns] += -(A @ skew(force)) if translations == "world" else skew(A.T @ force)
