"""Products of several matrices: the order of evaluation with the fewest operations.

The order is found by dynamic programming over the structural patterns of the factors. A partial product that has been
evaluated already costs nothing, so that products share their parts ("A_ij h_j" is formed once).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from codegen.ir.builder import Builder
from codegen.ir.lower.grid import Grid, Pattern, base_of, multiply, pattern_of, product_pattern, scale

Factors = tuple[Any, ...]
_Splits = dict[tuple[int, int], int]


@dataclass(slots=True)
class Chains:
    """Evaluates products and remembers every partial product.

    Attributes:
        builder: where the operations go.
        known: partial products that have been evaluated.
        finished: called with the factors and the value of each new partial product, to name it for readers.
    """

    builder: Builder
    known: dict[Factors, Grid]
    finished: Callable[[Factors, Grid], None]

    def product(self, factors: Factors, factor_grids: list[Grid]) -> Grid:
        """Evaluate the product of the factors, whose own values are given.

        Args:
            factors: keys of the factors, as they stand in the product.
            factor_grids: their values, shapes fit for the product.
        """
        splits = self._prepared(factors, factor_grids)
        return self._evaluate(factors, splits, 0, len(factors))

    def scaled(self, coefficient: Any, value: int, factors: Factors, factor_grids: list[Grid]) -> Grid:
        """Evaluate a scalar times a product; the scalar goes to the partial product with the fewest numbers.

        Args:
            coefficient: key of the scalar.
            value: its position in the program.
            factors: as for `product`.
            factor_grids: as for `product`.
        """
        splits = self._prepared(factors, factor_grids)
        return self._evaluate_scaled((coefficient, value), factors, splits, 0, len(factors))

    def _prepared(self, factors: Factors, factor_grids: list[Grid]) -> _Splits:
        for factor, grid in zip(factors, factor_grids, strict=True):
            self.known.setdefault((factor,), grid)
        return self._splits(factors)

    def _splits(self, factors: Factors) -> _Splits:
        """Best place to split each sub-product, by length."""
        count = len(factors)
        best: dict[tuple[int, int], tuple[int, Pattern]] = {}
        splits: _Splits = {}
        for length in range(1, count + 1):
            for start in range(count - length + 1):
                end = start + length
                grid = self.known.get(factors[start:end])
                if grid is not None:
                    best[start, end] = (0, pattern_of(grid, self.builder))
                    continue
                options = [self._option(best, start, middle, end) for middle in range(end - 1, start, -1)]
                cost, middle, pattern = min(options, key=lambda option: option[0])
                best[start, end] = (cost, pattern)
                splits[start, end] = middle
        return splits

    @staticmethod
    def _option(
        best: dict[tuple[int, int], tuple[int, Pattern]], start: int, middle: int, end: int
    ) -> tuple[int, int, Pattern]:
        left_cost, left = best[start, middle]
        right_cost, right = best[middle, end]
        pattern, cost = product_pattern(left, right)
        return left_cost + right_cost + cost, middle, pattern

    def _evaluate_scaled(
        self, scalar: tuple[Any, int], factors: Factors, splits: _Splits, start: int, end: int
    ) -> Grid:
        key = (scalar[0], "times", *factors[start:end])
        if key not in self.known:
            middle = splits.get((start, end))
            sizes = [self._size(factors, start, end)]
            if middle is not None:
                sizes += [self._size(factors, start, middle), self._size(factors, middle, end)]
            place = sizes.index(min(sizes))
            if middle is None or place == 0:
                result = scale(scalar[1], self._evaluate(factors, splits, start, end), self.builder)
            elif place == 1:
                left = self._evaluate_scaled(scalar, factors, splits, start, middle)
                result = multiply(left, self._evaluate(factors, splits, middle, end), self.builder)
            else:
                right = self._evaluate_scaled(scalar, factors, splits, middle, end)
                result = multiply(self._evaluate(factors, splits, start, middle), right, self.builder)
            self.known[key] = result
        return self.known[key]

    def _size(self, factors: Factors, start: int, end: int) -> int:
        """How many numbers a partial product holds; plus and minus one of a number count once."""
        if end - start > 1:
            return len(self.known[factors[start : start + 1]]) * len(self.known[factors[end - 1 : end]][0])
        bases = {base_of(entry, self.builder) for row in self.known[factors[start:end]] for entry in row}
        return len(bases - {self.builder.constant(0)})

    def _evaluate(self, factors: Factors, splits: _Splits, start: int, end: int) -> Grid:
        part = factors[start:end]
        if part not in self.known:
            middle = splits[start, end]
            left = self._evaluate(factors, splits, start, middle)
            right = self._evaluate(factors, splits, middle, end)
            self.known[part] = multiply(left, right, self.builder)
            self.finished(part, self.known[part])
        return self.known[part]
