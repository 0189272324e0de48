"""The files of ``generated/flops`` say what the rules and the programs say, and nothing else."""

import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from codegen import comparison
from codegen.counted import operations_per_step
from codegen.models import model
from codegen.report.charts import bar_chart, bars_of
from codegen.report.sheets import glance, per_step
from codegen.spec.request import Variant
from flopcount import rules
from flopcount.count import count
from flopcount.paper import DERIVATIVES, JOINTS, TABLE_7

FLOPS = Path(__file__).resolve().parents[2] / "generated" / "flops"


@pytest.fixture(scope="module")
def table_7() -> dict:
    return json.loads((FLOPS / "table7.json").read_text())


def row_of(document: dict, joint: str, derivative: str) -> dict:
    return next(row for row in document["rows"] if (row["joint"], row["derivative"]) == (joint, derivative))


@pytest.mark.parametrize("joint", JOINTS)
def test_table_7_holds_the_printed_numbers_and_those_of_the_rules(table_7, joint):
    for derivative in DERIVATIVES:
        row = row_of(table_7, joint, derivative)
        assert row["printed"]["conventional"] == TABLE_7[joint].conventional.of(derivative)
        assert row["printed"]["parametric"] == TABLE_7[joint].proposed.of(derivative)
        for form in ("conventional", "parametric"):
            assert row["rules"][form] == rules.tally(joint, derivative, form)
            assert row["vectors_first"][form] == rules.tally(joint, derivative, form, order="vectors")


def test_table_7_holds_the_counts_of_the_programs(table_7):
    for joint, kind, variant in (
        ("revolute", "conventional", Variant("revolute", "conventional", None)),
        ("universal", "parametric_table4", Variant("universal", "parametric", "table4")),
        ("ball", "parametric_substituted", Variant("ball", "parametric", "regular", "substituted")),
    ):
        for derivative in DERIVATIVES:
            counts = count(model(variant).program([derivative]))
            assert row_of(table_7, joint, derivative)["emitted"][kind]["total"] == counts.total


def test_table_2_holds_the_numbers_of_the_rules():
    document = json.loads((FLOPS / "table2.json").read_text())
    for row in document["rows"]:
        assert row["rules"] == rules.tally(row["constraint"], row["derivative"], "basic")
    assert len(document["rows"]) == 8


def test_the_rate_of_a_translational_joint_becomes_another_number_when_both_sides_are_counted_fairly(table_7):
    row = next(cells for cells in glance(table_7).rows if cells[:2] == ("translational", "phi_q"))
    printed, by_rules, vectors_first, fair = (float(cell.removesuffix(" %")) for cell in row[2:])
    assert printed == by_rules == 6.5
    assert vectors_first == 12.0
    assert fair > 2 * vectors_first


def test_what_the_paper_leaves_out_is_counted_apart(table_7):
    for joint in JOINTS:
        left_out = row_of(table_7, joint, "phi_q")["left_out"]
        angles = {"revolute": 1, "screw": 1, "cylindrical": 1, "planar": 1, "universal": 2, "ball": 3}.get(joint, 0)
        assert left_out["A_ij(alpha)"]["sincos"] == angles
        assert left_out["A_ij"]["total"] == 39, "two columns of the product, 15 each, and their cross product, 9"
        assert left_out["d_ij"]["total"] == 39, "two products of matrix and vector, and three sums of three"
        assert (left_out["dA_ij/dalpha"]["total"] > 0) == (angles > 0)


def test_the_misprints_of_the_tables_are_footnotes(table_7):
    text = (FLOPS / "table7.md").read_text()
    assert "trn2 and rot1" in text
    assert "494.4, must be 494.9" in text
    assert "not reproduced (239)" in text
    assert len(table_7["footnotes"]) == 2


def test_each_joint_has_a_chart_with_every_number_written_out(table_7):
    for row in table_7["rows"]:
        svg = (FLOPS / f"{row['joint']}.svg").read_text()
        ElementTree.fromstring(svg)
        texts = set(re.findall(r">([^<>]+)</text>", svg))
        for label, length in bars_of(row, table_7):
            assert label in texts
            assert f"{length:g}" in texts


def test_charts_are_readable_without_colour():
    colours = {
        colour.lower() for svg in FLOPS.glob("*.svg") for colour in re.findall(r"#[0-9a-fA-F]{6}\b", svg.read_text())
    }
    greys = {colour for colour in colours if colour[1:3] == colour[3:5] == colour[5:7]}
    assert colours == greys


def test_a_chart_is_the_same_bytes_each_time(table_7):
    assert bar_chart(table_7, "planar") == bar_chart(table_7, "planar")
    assert bar_chart(table_7, "planar") == (FLOPS / "planar.svg").read_text()


def test_the_page_holds_every_chart_and_loads_nothing():
    page = (FLOPS / "index.html").read_text()
    assert page.count("<svg") == 8
    assert not re.search(r"(src|href)=\"https?:", page)


def test_prepared_geometry_leaves_fifteen_operations_to_the_translational_joint():
    programs = [
        model(Variant("translational", "parametric", "regular", "substituted")).program([d]) for d in DERIVATIVES
    ]
    assert sum(operations_per_step(program) for program in programs) == 15
    rotation, with_tilde = 15 + 15 + 9, 27
    assert sum(count(program).total for program in programs) == rotation + with_tilde + 15, "C_i C_j^T, C_i C_j^T s_j~"


def test_the_sheet_of_steps_shows_what_is_left_of_each_routine():
    rows = [
        {"joint": "ball", "derivative": "phi_q", "per_step": {"conventional": 54}},
        {"joint": "ball", "derivative": "phi_q_t_lambda_q", "per_step": {"conventional": 50, "parametric": 7}},
    ]
    sheet = per_step({"table": "7", "columns": {"conventional": "conv.", "parametric": "param."}, "rows": rows})
    assert [row[2:] for row in sheet.rows] == [("54", ""), ("50", "7")]
    assert sheet.columns[2:] == ("conv.", "param.")


def test_the_left_out_operations_are_those_of_a_program():
    assert comparison.left_out_operations("ball")["A_ij(alpha)"].counts.sincos == 3


def test_the_readme_tells_the_rates_of_the_translational_joint_as_they_are(table_7):
    row = next(cells for cells in glance(table_7).rows if cells[:2] == ("translational", "phi_q"))
    readme = " ".join((FLOPS.parents[1] / "README.md").read_text().split())
    assert f"costs {row[2]} of the conventional one" in readme
    assert f"from the vector it is {row[4]}; with everything counted on both sides it is {row[5]}." in readme
