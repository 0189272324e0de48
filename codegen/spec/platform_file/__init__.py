"""A platform file (TOML, `docs/platform.md`) read, checked and turned into a `codegen.spec.platform.Platform`.

The machinery is that of scene files (`codegen.spec.scene_file`): `entries` declares the keys, `poses` and `legs` check
what stands in them, and all mistakes of a file are reported at once.
"""

from codegen.spec.platform_file.reading import read_platform

__all__ = ["read_platform"]
