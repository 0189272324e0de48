"""Compiler flags."""
