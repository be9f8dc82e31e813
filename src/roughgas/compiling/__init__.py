"""Compiling a kernel, which is plain Python, to machine code, and caching it on the disk."""
