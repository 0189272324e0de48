"""Velocity indices of a platform: our routines beside numpy, Eigen and C written by CasADi."""
