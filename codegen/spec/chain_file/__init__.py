"""A chain file (TOML, `docs/chain.md`) read, checked and turned into a `codegen.spec.chain.Chain`.

It goes the way of `codegen.spec.scene_file`, whose tables, entries and values it uses: `entries` declares the keys,
`links`, `hung`, `loads` check what belongs together, `reading` does it all in order.
"""

from codegen.spec.chain_file.reading import read_chain
from codegen.spec.chain_file.schema import schema_text

__all__ = ["read_chain", "schema_text"]
