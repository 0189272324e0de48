"""The counter of C text, on functions written by hand."""

from __future__ import annotations

import pytest

from flopcount.count_c import count_c
from flopcount.counts import Counts

SIGNATURE = "void f(const jg_real *JG_RESTRICT x, jg_real *JG_RESTRICT y)"


def counted(*statements: str) -> Counts:
    body = "\n".join(f"    {statement}" for statement in statements)
    return count_c(f"{SIGNATURE}\n{{\n{body}\n}}\n")["f"]


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("y[0] = x[0];", Counts()),
        ("y[0] = x[0] + x[1] - x[2];", Counts(add=2)),
        ("y[0] = x[0] * x[1] / x[2];", Counts(mul=1, div=1)),
        ("y[0] = -x[0];", Counts(neg=1)),
        ("y[0] = -(x[0] - x[1]);", Counts(neg=1, add=1)),
        ("y[0] = x[0] - -x[1];", Counts(neg=1, add=1)),
        ("y[0] = x[0] * -x[1];", Counts(neg=1, mul=1)),
        ("y[0] = (-x[0]) * (x[1] + x[2]);", Counts(neg=1, mul=1, add=1)),
        ("y[0] = (x[0])-(x[1]);", Counts(add=1)),
        ("y[0] = a-b;", Counts(add=1)),
        ("y[0] = jg_sqrt(-a);", Counts(sqrt=1, neg=1)),
        ("y[0] = jg_fma(a, b, c);", Counts(fma=1)),
        ("y[0] = jg_fma(-a, b - c, -x[2]) + jg_fma(a, b, c * x[1]);", Counts(fma=2, neg=2, add=2, mul=1)),
        ("y[0] = jg_atan2(-a, b - c);", Counts(atan2=1, neg=1, add=1)),
    ],
)
def test_a_sign_behind_an_operand_is_binary(statement: str, expected: Counts) -> None:
    assert counted(statement) == expected


@pytest.mark.parametrize(
    "literal",
    ["JG_REAL(1.0)", "JG_REAL(-1.0)", "JG_REAL(1e-05)", "JG_REAL(-2.5e+300)", "JG_REAL(0.3333333333333333)"],
)
def test_signs_and_exponents_of_literals_are_no_operations(literal: str) -> None:
    assert counted(f"y[0] = {literal};") == Counts()
    assert counted(f"y[0] = {literal} * x[0] - {literal};") == Counts(mul=1, add=1)
    assert counted(f"y[0] = x[0] + {literal};") == Counts(add=1)


@pytest.mark.parametrize("literal", ["1.0", "1e-5", "2.5E+3", "17"])
def test_bare_literals_are_operands(literal: str) -> None:
    assert counted(f"y[0] = {literal} - x[0];") == Counts(add=1)
    assert counted(f"y[0] = x[0] * {literal};") == Counts(mul=1)


def test_index_arithmetic_and_pointers_are_free() -> None:
    assert counted("y[3 * 2 + 1] = x[0 - 0] + x[2 * (1 + 1)];") == Counts(add=1)
    assert counted("const jg_real *const C_i = x + 3;", "y[0] = C_i[0] * x[1];") == Counts(mul=1)
    assert counted("y[x[1 + 1] - 1] = a;") == Counts()


def test_calls_nest() -> None:
    assert counted("y[0] = jg_sqrt(jg_sin(a) * jg_sin(a) + jg_cos(b - c));") == Counts(
        sqrt=1, sin=2, cos=1, mul=1, add=2
    )
    assert counted("jg_sincos(a + b, &s, &c);", "y[0] = s * c;") == Counts(sincos=1, add=1, mul=1)


def test_comments_are_not_read() -> None:
    assert counted("/* a * b + c / d - e */ y[0] = x[0]; /* -x */") == Counts()
    assert counted("/* two", "   * lines - and / signs */", "y[0] = x[0] * x[1];") == Counts(mul=1)


def test_a_statement_may_run_over_lines() -> None:
    assert counted("y[0] = x[0] * x[1]", "    + x[2] * x[3]", "    - x[4];") == Counts(mul=2, add=2)


def test_a_function_counts_as_those_it_calls() -> None:
    source = f"""
{SIGNATURE}
{{
    y[0] = x[0] * x[1];
}}

void g(const jg_real *JG_RESTRICT x, jg_real *JG_RESTRICT y)
{{
    jg_real y_nz[1];
    f(x, y_nz);
    f(x, y_nz);
    jg_scatter(pattern(), y_nz, y);
    y[0] = -y[1] + y[2];
}}

const int *pattern(void)
{{
    static const int pattern[] = {{ 1, 1, 0, 1, 0 }};
    return pattern;
}}
"""
    assert count_c(source) == {"f": Counts(mul=1), "g": Counts(mul=2, add=1, neg=1)}


def test_an_empty_text_has_no_functions() -> None:
    assert count_c("") == {}
    assert counted("(void)y;") == Counts()
