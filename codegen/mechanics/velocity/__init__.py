"""Velocity indices of six-legged platforms (S3), derived in named stages."""
