"""Pictures of a platform and of a sweep, and the page that shows them."""

from __future__ import annotations

import codegen
from codegen.platforms.run import Table
from codegen.report.findings import Finding
from codegen.report.index_maps import index_maps
from codegen.report.page import page
from codegen.report.pareto_front import pareto_picture
from codegen.report.platform_pictures import ellipsoids_picture
from codegen.spec.platform import Platform


def platform_report(platform: Platform, table: Table) -> dict[str, bytes]:
    """Draw the pictures of a sweep.

    Args:
        platform: whose.
        table: what was found.

    Returns:
        File name -> content: SVG, and ``report.html`` with all of them.
    """
    pictures = {"ellipsoids.svg": ellipsoids_picture(platform), "pareto.svg": pareto_picture()}
    maps = index_maps(table)
    if maps is not None:
        pictures = {"maps.svg": maps, **pictures}
    text = f"{table.words}. Ellipsoids are drawn at home, each motion to its own scale."
    finding = Finding(f"Platform {platform.name}", (text,), pictures, None, "")
    files = {**pictures, "report.html": page([finding], codegen.__version__)}
    return {name: content.encode() for name, content in files.items()}
