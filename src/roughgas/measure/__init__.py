"""From the kernel's sums over particles to energies, steady states, plateaus and error bars."""
