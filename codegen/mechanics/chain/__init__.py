"""Complex kinematic chains (S2), symbolically, stage by stage; `model` gives the program of what is asked for."""
