"""The measured trade: what accuracy costs on this machine, which variant is the cheapest that suffices."""
