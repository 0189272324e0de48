"""Compile and call generated C routines from their manifest alone."""
