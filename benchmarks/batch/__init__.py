"""Time the batch routines against the scalar loop and against the memory."""
