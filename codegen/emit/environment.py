"""The one Jinja environment: strict, and the place where the templates are found."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import jinja2


def template_folder() -> Path:
    """Where the templates lie: in the installed package, or at the top of the repository."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "_templates"
    return installed if installed.is_dir() else package.parent / "templates"


@cache
def environment() -> jinja2.Environment:
    """Give the environment; an undefined name in a template is an error."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(template_folder()),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def render(template: str, **values: object) -> str:
    """Render a template to text."""
    return environment().get_template(template).render(**values)
