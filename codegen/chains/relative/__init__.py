"""A scene by relative coordinates: as a chain."""

from codegen.chains.relative.convert import Relative, relative

__all__ = ["Relative", "relative"]
