"""Joint frames from the pose at t = 0: exact rational vectors of three, and which axes a joint frame is given.

A joint frame has its third axis along the axis of the joint. Its first axis is free for most joints: it is laid along
an axis of a body where one is perpendicular, so that as many components as possible are 0 or 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from decimal import Context, Decimal
from fractions import Fraction

from codegen.spec.scene import Marker, Matrix, Quaternion, Vector

NEARLY = Fraction(1, 10**9)
"""A component below this part of a vector's length is none: it comes from digits that the file leaves out."""

_ROUNDING = Fraction(1, 10**12)
"""A difference of positions below this part of them is none."""

_DIGIT = Fraction(1, 10**39)
"""What square roots leave in the place of 0 or 1 is below it."""

_DIGITS = Context(prec=45)

IDENTITY: Matrix = tuple(tuple(Fraction(int(i == k)) for k in range(3)) for i in range(3))  # type: ignore[assignment]


def rotation(quaternion: Quaternion) -> Matrix:
    """Rotation matrix of a quaternion of any length, body to world, exactly orthonormal."""
    w, x, y, z = quaternion
    scale = 2 / (w * w + x * x + y * y + z * z)
    return (
        (1 - scale * (y * y + z * z), scale * (x * y - w * z), scale * (x * z + w * y)),
        (scale * (x * y + w * z), 1 - scale * (x * x + z * z), scale * (y * z - w * x)),
        (scale * (x * z - w * y), scale * (y * z + w * x), 1 - scale * (x * x + y * y)),
    )


def times(matrix: Matrix, vector: Vector) -> Vector:
    """Matrix times vector."""
    return _three(dot(row, vector) for row in matrix)


def turned_back(matrix: Matrix, vector: Vector) -> Vector:
    """Transpose of a matrix times vector: world components in body axes."""
    return times(transposed(matrix), vector)


def transposed(matrix: Matrix) -> Matrix:
    """Transpose."""
    a, b, c = (_three(row[k] for row in matrix) for k in range(3))
    return a, b, c


def dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    """Scalar product."""
    return sum((x * y for x, y in zip(a, b, strict=True) if x and y), Fraction(0))


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product."""
    return _three(a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3))


def difference(a: Vector, b: Vector) -> Vector:
    """``a - b``; what is left of equal positions by the last digits of the file is taken away."""
    size = max(map(abs, (*a, *b)), default=Fraction(0))
    return _three(x - y if abs(x - y) > _ROUNDING * size else Fraction(0) for x, y in zip(a, b, strict=True))


def square_root(value: Fraction) -> Fraction:
    """Square root of a number that is not negative: exact where it is rational, else to 40 digits."""
    decimal = _DIGITS.divide(Decimal(value.numerator), Decimal(value.denominator))
    root = Fraction(_DIGITS.sqrt(decimal))
    simple = root.limit_denominator(10**15)
    return simple if simple * simple == value else root


def length(vector: Sequence[Fraction]) -> Fraction:
    """Length of a vector."""
    return square_root(dot(vector, vector))


def unit(vector: Vector) -> Vector:
    """Direction of a vector that is not zero; components that are nearly 0 are 0."""
    return _normalised(on_axes(vector))


def on_axes(vector: Vector) -> Vector:
    """A vector without the components that are nearly 0 beside the others."""
    size = max(map(abs, vector))
    return _three(x if abs(x) > NEARLY * size else Fraction(0) for x in vector)


def frame(third: Vector, preferred: Iterable[Vector] = IDENTITY) -> Matrix:
    """Joint frame ``[f g h]`` with a given third axis, all in the same axes.

    Args:
        third: direction of h, any length.
        preferred: unit vectors for f, in order; the first that is perpendicular to h is taken, else what is across h of
            the one that is least along it.
    """
    h = unit(third)
    along = [(abs(dot(direction, h)), direction) for direction in preferred]
    across = (direction for size, direction in along if size <= NEARLY)
    f = perpendicular(unit(next(across, None) or min(along, key=lambda pair: pair[0])[1]), h)
    return columns(f, cross(h, f), h)


def perpendicular(direction: Vector, h: Vector) -> Vector:
    """Unit vector nearest to a direction among those that are perpendicular to a unit vector."""
    along = dot(direction, h)
    return _normalised(_three(x - along * y for x, y in zip(direction, h, strict=True)) if along else direction)


def columns(f: Vector, g: Vector, h: Vector) -> Matrix:
    """The matrix with these columns; components within the rounding of square roots of 0 or 1 are 0 or 1."""
    return transposed((_rounded(f), _rounded(g), _rounded(h)))


def _rounded(vector: Vector) -> Vector:
    return _three(Fraction(round(x)) if abs(x - round(x)) < _DIGIT else x for x in vector)


def marker(point: Vector, axes: Matrix, position: Vector, attitude: Matrix) -> Marker:
    """A joint frame that is given in world axes, on a body.

    Args:
        point: [3] m, world.
        axes: [f g h], world.
        position: [3] m of the body, world.
        attitude: [3, 3] of the body, body to world.
    """
    f, _, h = transposed(axes)
    h = unit(turned_back(attitude, h))
    f = perpendicular(unit(turned_back(attitude, f)), h)
    return Marker(on_axes(turned_back(attitude, difference(point, position))), columns(f, cross(h, f), h))


def _normalised(vector: Vector) -> Vector:
    size = length(vector)
    return vector if size == 1 else _three(x / size for x in vector)


def _three(values: Iterable[Fraction]) -> Vector:
    x, y, z = values
    return x, y, z
