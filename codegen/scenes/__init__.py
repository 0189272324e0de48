"""The pipeline for scenes: from a mechanism to the routines of that mechanism.

Stages, each a pure function of the one before:

1. `read`      file -> scene (:mod:`codegen.spec`)
2. `forms`     scene -> the form of each joint, the cheaper one where it is free
3. `numbers`   scene -> rows that are independent, degrees of freedom (:mod:`codegen.measure`)
4. `programs`  assembly -> programs (:mod:`codegen.mechanics.assembly`, lowering and passes as in `codegen.build`)
5. `bill`      what each simplification saves
6. `generate`  C, CasADi, manifest, README and an example
"""

from codegen.scenes.read import read

__all__ = ["read"]
