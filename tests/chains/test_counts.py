"""What a chain costs in operations: what the documentation says, and the same for each link of a long one."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import pytest

from codegen.chains.programs import FUSED, program
from codegen.spec.chain import BASE, Chain, Link, Row
from codegen.spec.chain_file import read_chain
from flopcount.count import count
from tests.mechanics.chain.series import Account
from tests.mechanics.chain.trees import example, start

PAGE = (Path(__file__).parents[2] / "docs" / "chain.md").read_text()
NAMES = {"quick return": "quick_return", "spatial slider-crank": "spatial_slider_crank"}
TOLD = re.findall(r"^\| (quick return|spatial slider-crank) \| (\d+) \|$", PAGE, re.MULTILINE)


@pytest.mark.parametrize(("mechanism", "operations"), TOLD)
def test_the_page_tells_the_operations_of_the_mechanisms(mechanism, operations):
    assert count(program(example(NAMES[mechanism]), FUSED)).total == int(operations)


def test_the_worked_example_of_the_page_is_closed_at_the_start():
    text = PAGE.split("```toml\n")[1].split("```")[0]
    chain = read_chain(text, "docs/chain.md")
    assert abs(Account(chain, start(chain)).phi()).max() < 1e-14


@pytest.mark.parametrize("quantity", ["frames", "f_C", "wrenches"])
def test_every_further_link_costs_the_same(quantity):
    costs = [count(program(arm(size), (quantity,))).total for size in (6, 9, 12)]
    assert costs[1] - costs[0] == costs[2] - costs[1]


def arm(size: int) -> Chain:
    """Bent links, all alike, one on the other."""
    row = Row(alpha=Fraction("0.7"), a=Fraction("0.3"), d=Fraction("0.2"))
    inertia = tuple(tuple(Fraction(int(i == k)) for k in range(3)) for i in range(3))
    centre = (Fraction("0.1"), Fraction("0.2"), Fraction("0.3"))
    links = [
        Link(f"link {k}", f"link {k - 1}" if k else BASE, "revolute", row, Fraction(1), centre, inertia)
        for k in range(size)
    ]
    return Chain("arm", (Fraction(0), Fraction(0), Fraction("-9.81")), tuple(links))
