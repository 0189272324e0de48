"""The simulations of S2: quick return and spatial slider-crank, as figures in the documentation."""
