"""Find Eigen's headers: a folder named by hand, a Python package that ships them, the system's."""

from __future__ import annotations

import os
import site
import sys
from pathlib import Path

REMEDY = "install it with pip install cmeel-eigen or apt-get install libeigen3-dev, or set EIGEN_INCLUDE"


def eigen_include() -> Path:
    """Folder that holds ``Eigen/Core``.

    Raises:
        ModuleNotFoundError: there is none.
    """
    packages = [Path(folder) for folder in [*site.getsitepackages(), *sys.path] if folder]
    places = [Path(os.environ["EIGEN_INCLUDE"])] if os.environ.get("EIGEN_INCLUDE") else []
    places += [folder / "cmeel.prefix/include/eigen3" for folder in packages]
    places += [Path("/usr/include/eigen3"), Path("/usr/local/include/eigen3")]
    for place in places:
        if (place / "Eigen/Core").exists():
            return place
    raise ModuleNotFoundError(f"Eigen's headers are not found; {REMEDY}")
