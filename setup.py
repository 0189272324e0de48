"""Package discovery; everything else about the distribution is in pyproject.toml.

The templates live in `templates/` at the top of the repository and are installed as data inside `codegen`, in
the directory `codegen/_templates`. In a checkout or an editable install that directory does not exist and the
templates are read where they lie.
"""

from setuptools import find_namespace_packages, find_packages, setup

TEMPLATES = "codegen._templates"

templates = [TEMPLATES, *(f"{TEMPLATES}.{name}" for name in find_namespace_packages("templates"))]

setup(
    packages=[*find_packages(include=["codegen*", "flopcount*"]), *templates],
    package_dir={TEMPLATES: "templates"},
    package_data={"": ["py.typed"], **{name: ["*"] for name in templates}},
)
