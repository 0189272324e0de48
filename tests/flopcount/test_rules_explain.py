"""The explanation of a cell is a derivation: its lines name what is formed, and add up to the cell."""

import pytest

from flopcount import paper
from flopcount.rules import RULES, cells, explain, parts, tally
from flopcount.rules.switches import Cell

ALL = list(cells())


def lines(name: str, derivative: paper.Derivative, form: str, place: str) -> list[tuple[str, int]]:
    terms = explain(name, derivative, form)  # type: ignore[arg-type]
    return [(term.text, term.operations) for term in terms if term.place == place]


@pytest.mark.parametrize("cell", ALL, ids=str)
@pytest.mark.parametrize("order", ["paper", "vectors"])
def test_terms_add_up_to_the_tally(cell: Cell, order: str) -> None:
    terms = explain(cell.name, cell.derivative, cell.form, order=order)
    assert sum(term.operations for term in terms) == tally(cell.name, cell.derivative, cell.form, order=order)
    assert all(term.operations >= 0 and term.text and term.rule in RULES for term in terms)


@pytest.mark.parametrize("cell", ALL, ids=str)
def test_every_block_is_explained(cell: Cell) -> None:
    terms = explain(cell.name, cell.derivative, cell.form)
    blocks = {
        (part.label, block.place) for part in parts(cell.name, cell.form) for block in part.blocks(cell.derivative)
    }
    assert {(term.part, term.place) for term in terms} == blocks


def test_revolute_jacobian() -> None:
    assert lines("revolute", "phi_q", "parametric", "(trn0, pi_j)") == [("A_ij s_j~", 27)]
    assert lines("revolute", "phi_q", "parametric", "(rot1 row 1, pi_j)") == [
        ("s1 f_j^T", 3),
        ("c1 g_j^T", 3),
        ("s1 f_j^T + c1 g_j^T", 3),
    ]


def test_revolute_second_derivative() -> None:
    second: paper.Derivative = "phi_q_t_lambda_q"
    assert lines("revolute", second, "parametric", "(r_j, alpha_1)") == [("D_1^T lambda", 15)]
    assert lines("revolute", second, "parametric", "(pi_j, alpha_1)")[0] == ("s_j~ (D_1^T lambda)", 9)


def test_dot_2_jacobian() -> None:
    assert lines("dot-2", "phi_q", "basic", "(dot-2, pi_i)") == [
        ("A_i^T d_ij~", 27),
        ("f_i^T (A_i^T d_ij~)", 15),
        ("(f_i^T (A_i^T d_ij~)) A_i", 15),
        ("f_i^T s_i~", 9),
        ("f_i^T A_i^T d_ij~ A_i + f_i^T s_i~", 3),
    ]
    assert lines("dot-2", "phi_q", "basic", "(dot-2, r_j)") == [("f_i^T A_i^T", 0)]


def test_dot_2_second_derivative_takes_a_finished_block_as_operand() -> None:
    assert lines("dot-2", "phi_q_t_lambda_q", "basic", "(pi_j, pi_j)") == [("(lambda s_j~ A_ij^T f_i~) A_ij", 45)]


def test_screw_second_derivative_forms_the_common_product_once() -> None:
    assert lines("screw", "phi_q_t_lambda_q", "basic", "(pi_j, pi_i)") == [
        ("A_ij^T h_i~", 27),
        ("s_j~ (A_ij^T h_i~)", 27),
        ("lambda s_j~ A_ij^T h_i~", 9),
        ("p lambda A_ij^T h_i~", 9),
        ("-lambda s_j~ A_ij^T h_i~ + p lambda A_ij^T h_i~", 9),
    ]


def test_ball_alpha_block_takes_a_finished_entry_as_term() -> None:
    second: paper.Derivative = "phi_q_t_lambda_q"
    costs = {
        place: sum(cost for _, cost in lines("ball", second, "parametric", place))
        for place in (f"(alpha_{m}, alpha_{k})" for k in (1, 2, 3) for m in (1, 2, 3))
    }
    assert costs == {
        "(alpha_1, alpha_1)": 2,
        "(alpha_2, alpha_1)": 2,
        "(alpha_3, alpha_1)": 0,
        "(alpha_1, alpha_2)": 0,
        "(alpha_2, alpha_2)": 5,
        "(alpha_3, alpha_2)": 2,
        "(alpha_1, alpha_3)": 0,
        "(alpha_2, alpha_3)": 0,
        "(alpha_3, alpha_3)": 2,
    }


def test_spherical_constraint_of_a_conventional_joint_is_named() -> None:
    names = list(dict.fromkeys(term.part for term in explain("revolute", "phi_q", "conventional")))
    assert names == ["spherical", "dot-1(f_i, h_j)", "dot-1(g_i, h_j)"]
