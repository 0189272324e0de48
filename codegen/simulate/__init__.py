"""Integrate the equations of motion of a scene: emitted residual and Jacobian, compiled, inside SUNDIALS IDA."""
