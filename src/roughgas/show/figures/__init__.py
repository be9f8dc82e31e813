"""Figures of the paper and of what it leaves open, drawn from reduced data beside theory."""
