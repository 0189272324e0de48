"""Scenes of many equal mechanisms: straight-line code, loops, and the library's routines joint by joint."""
