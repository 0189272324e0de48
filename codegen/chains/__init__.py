"""Chains: routines of one chain, and runs of it (S2)."""
