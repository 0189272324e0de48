"""Prescribed motions of independent coordinates: value, rate and acceleration by time."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.polynomial import Polynomial as Powers
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from codegen.errors import Mistake, SpecificationError
from codegen.spec.chain import Chain
from codegen.spec.chain_motions import Harmonic, Independent, Motion, Polynomial, Table

Array = NDArray[np.float64]

At = Callable[[float], tuple[float, float, float]]
"""Value, rate and acceleration at a time."""

_DEGREE = 5
"""Of the spline through a table: its acceleration is smooth. Fewer than 6 points have a lower one."""


class Motions:
    """The motions of all independent coordinates."""

    def __init__(self, functions: list[At]) -> None:
        self._functions = functions

    def at(self, t: float) -> tuple[Array, Array, Array]:
        """Give q_v, qd_v and qdd_v, [nv] each."""
        values = np.array([function(t) for function in self._functions]).reshape(-1, 3)
        return values[:, 0], values[:, 1], values[:, 2]


def motions(chain: Chain, tables: Mapping[str, str], duration: float) -> Motions:
    """Make the motions of a chain.

    Args:
        chain: all of its independent coordinates have one.
        tables: text of the CSV files, by the names that the chain has for them.
        duration: s, that tables must cover.

    Raises:
        SpecificationError: coordinates without a motion, tables that cannot be used; all at once.
    """
    return _motions(chain.independents, tables, duration)


class Drives:
    """Motions of the independent coordinates that are driven while others move under forces.

    Attributes:
        is_driven: [nv] which they are.
        longest: s, a step that overlooks nothing of the motions.
    """

    def __init__(self, is_driven: NDArray[np.bool_], given: Motions, longest: float) -> None:
        self.is_driven, self.longest, self._given = is_driven, longest, given

    def at(self, t: float) -> tuple[Array, Array, Array]:
        """Give values, rates and accelerations, [nd] each."""
        return self._given.at(t)


def drives(chain: Chain, tables: Mapping[str, str], duration: float) -> Drives:
    """Make the motions of the driven coordinates of a chain.

    Args:
        chain: the chain.
        tables: text of the CSV files, by the names that the chain has for them.
        duration: s, that tables must cover.

    Raises:
        SpecificationError: coordinates without a motion, tables that cannot be used; all at once.
    """
    driven = tuple(one for one in chain.independents if one.driven)
    given = _motions(driven, tables, duration)
    longest = min((_step(one.motion, tables) for one in driven if one.motion is not None), default=math.inf)
    return Drives(np.array([one.driven for one in chain.independents], dtype=bool), given, longest)


def _step(motion: Motion, tables: Mapping[str, str]) -> float:
    """s, a step in which a motion does not come and go."""
    if isinstance(motion, Polynomial):
        return math.inf
    if isinstance(motion, Harmonic):
        return abs(1 / float(motion.frequency)) if motion.frequency else math.inf
    return min(after - before for before, after in itertools.pairwise(t for t, _ in _lines(tables[motion.file])))


def _motions(independents: Sequence[Independent], tables: Mapping[str, str], duration: float) -> Motions:
    mistakes: list[Mistake] = []
    functions: list[At] = []
    for independent in independents:
        place = f'independent coordinate "{independent.joint}"'
        if independent.motion is None:
            remedy = "give polynomial, harmonic or table"
            mistakes.append(Mistake(place, "has no motion", remedy))
            continue
        if isinstance(independent.motion, Table):
            found = list(_table_mistakes(tables[independent.motion.file], independent.motion.file, duration))
            mistakes += found
            if found:
                continue
        functions.append(function(independent.motion, tables))
    if mistakes:
        raise SpecificationError(mistakes)
    return Motions(functions)


def function(motion: Motion, tables: Mapping[str, str]) -> At:
    """Give a motion as a function of time."""
    if isinstance(motion, Polynomial):
        powers = Powers([float(c) for c in motion.coefficients])
        derivatives = (powers, powers.deriv(1), powers.deriv(2))
        return lambda t: (float(derivatives[0](t)), float(derivatives[1](t)), float(derivatives[2](t)))
    if isinstance(motion, Harmonic):
        return _harmonic(motion)
    t, values = np.array(list(_lines(tables[motion.file]))).T
    spline = make_interp_spline(t, values, k=_degree(len(t)))
    rates = (spline, spline.derivative(1), spline.derivative(2) if spline.k > 1 else np.zeros_like)
    return lambda at: (float(rates[0](at)), float(rates[1](at)), float(rates[2](at)))


def _harmonic(motion: Harmonic) -> At:
    mean, speed, amplitude = float(motion.mean), float(motion.speed), float(motion.amplitude)
    frequency, phase = float(motion.frequency), float(motion.phase)

    def at(t: float) -> tuple[float, float, float]:
        sine, cosine = math.sin(frequency * t + phase), math.cos(frequency * t + phase)
        value, rate = mean + speed * t + amplitude * sine, speed + amplitude * frequency * cosine
        return value, rate, -amplitude * frequency**2 * sine

    return at


def _degree(points: int) -> int:
    """Odd, and less than the number of points."""
    return min(_DEGREE, points - 1 if points % 2 == 0 else points - 2)


def _lines(text: str) -> Iterator[tuple[float, float]]:
    """Times and values; a first line that holds no numbers is a heading.

    Raises:
        ValueError: a line is not two finite numbers; its number stands in the error.
    """
    for number, fields in enumerate(csv.reader(text.splitlines()), 1):
        if not any(field.strip() for field in fields):
            continue
        try:
            t, value = map(float, fields)
            is_finite = math.isfinite(t) and math.isfinite(value)
        except ValueError:
            if number == 1:
                continue
            is_finite = False
        if not is_finite:
            raise ValueError(number)
        yield t, value


def _table_mistakes(text: str, file: str, duration: float) -> Iterator[Mistake]:
    try:
        times = [t for t, _ in _lines(text)]
    except ValueError as error:
        yield Mistake(file, f"line {error} is not two numbers", "write t in s and the coordinate, separated by a comma")
        return
    if len(times) < 2:
        yield Mistake(file, f"has {len(times)} points", "give at least 2")
        return
    if any(after <= before for before, after in itertools.pairwise(times)):
        yield Mistake(file, "times do not grow from line to line", "sort the lines by t")
    elif times[0] > 0 or times[-1] < duration:
        what = f"covers {times[0]:g} s to {times[-1]:g} s, and the run takes 0 to {duration:g} s"
        yield Mistake(file, what, "give a longer table, or a shorter --duration")
