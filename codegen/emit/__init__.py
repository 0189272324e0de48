"""Emitters: a program and its signature -> text (C) or a CasADi function, and the package around them."""
