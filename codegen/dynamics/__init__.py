"""The equations of motion as programs for an implicit integrator: residual and Jacobian over one state vector."""
