"""What the tests measured: kept with each test's report (user properties), and summed up at the end of a session."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


class Notes:
    """Keeps the worst value seen in a test under each name: the largest, or the least of names with "smallest".

    Args:
        properties: (name, value) pairs of the test's report, `user_properties` of pytest.
    """

    def __init__(self, properties: list[tuple[str, object]]) -> None:
        self._properties = properties
        self._values: dict[str, float] = {}
        self._places: dict[str, int] = {}

    def __call__(self, name: str, value: float) -> None:
        """Note a value."""
        self._values[name] = worse(name, self._values.get(name), float(value))
        if name not in self._places:
            self._places[name] = len(self._properties)
            self._properties.append((name, 0.0))
        self._properties[self._places[name]] = (name, self._values[name])


def worse(name: str, first: float | None, second: float) -> float:
    """The worse of two values under one name."""
    if first is None:
        return second
    return min(first, second) if "smallest" in name else max(first, second)


def summary(reports: Iterable[Any]) -> list[str]:
    """One line for each claim and name: the worst value and the case it belongs to."""
    worst: dict[tuple[str, str], tuple[float, str]] = {}
    for report in reports:
        claim, _, case = report.nodeid.partition("[")
        for name, value in report.user_properties:
            key = (claim.rpartition("::")[2], name)
            if key not in worst or worse(name, worst[key][0], value) != worst[key][0]:
                worst[key] = (value, case.rstrip("]"))
    return [f"{value:9.2e}  {claim}: {name} ({case})" for (claim, name), (value, case) in sorted(worst.items())]
