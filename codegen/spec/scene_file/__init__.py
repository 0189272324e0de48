"""A scene file (TOML, `docs/scene.md`) read, checked and turned into a `codegen.spec.scene.Scene`.

`read_scene` does it in this order, and all mistakes of a file are reported at once:

1. `tables`: TOML text to tables, numbers exact;
2. `entries`, `entry`, `values`: tables to entries, key by key; every key is declared there with unit and meaning;
3. `names`, `bodies`, `joints`, `axes`, `coordinates`, `forces`: entries are checked, and made into bodies and joints;
4. `gaps`, `planar`: the mechanism is checked in its pose at t = 0;
5. `copies`: it is repeated.

`schema` makes the JSON schema from `entries`.
"""

from codegen.spec.scene_file.reading import read_scene

__all__ = ["read_scene"]
