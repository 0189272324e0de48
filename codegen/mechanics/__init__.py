"""Symbolic models of the joints: where the papers' equations stand, as staged matrix expressions in sympy."""
