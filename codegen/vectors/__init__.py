"""The vector level between the symbolic model and the scalar program.

Expressions are read free of frames (`read`), every way to evaluate them is laid out (`vectors`, `scalars`, `blocks`),
the cheapest is searched (`search`) and written out in scalars (`scalarise`).
"""
