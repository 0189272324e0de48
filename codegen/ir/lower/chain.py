"""Products of several matrices: the order of evaluation with the fewest operations.

The order is found by dynamic programming over the structural patterns of the factors. A partial product that has been
evaluated already costs nothing, so that products share their parts ("A_ij h_j" is formed once).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from codegen.ir.builder import Builder
from codegen.ir.lower.grid import Grid, Pattern, multiply, pattern_of, product_pattern

Factors = tuple[Any, ...]


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
        for factor, grid in zip(factors, factor_grids, strict=True):
            self.known.setdefault((factor,), grid)
        splits = self._splits(factors)
        return self._evaluate(factors, splits, 0, len(factors))

    def _splits(self, factors: Factors) -> dict[tuple[int, int], int]:
        """Best place to split each sub-product, by length."""
        count = len(factors)
        best: dict[tuple[int, int], tuple[int, Pattern]] = {}
        splits: dict[tuple[int, int], int] = {}
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

    def _evaluate(self, factors: Factors, splits: dict[tuple[int, int], int], start: int, end: int) -> Grid:
        part = factors[start:end]
        if part not in self.known:
            middle = splits[start, end]
            left = self._evaluate(factors, splits, start, middle)
            right = self._evaluate(factors, splits, middle, end)
            self.known[part] = multiply(left, right, self.builder)
            self.finished(part, self.known[part])
        return self.known[part]
