"""How plain Python becomes a kernel's machine code, and where that is kept."""
