"""The pipeline for six-legged platforms: file -> programs -> package; sweeps of poses."""
