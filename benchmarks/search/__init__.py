"""A long search for the cheapest evaluation of every routine of the library; ``make search``."""
