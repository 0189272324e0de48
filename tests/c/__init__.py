"""What a C compiler, and a program that is made with it, say of the generated routines."""
