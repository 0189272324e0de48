"""Forces and equations of motion of scenes."""
