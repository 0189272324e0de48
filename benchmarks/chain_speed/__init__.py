"""The routines of a chain beside a recursion that reads the chain from a table."""
