"""Figures of R beside theory, of single datasets, and of evidence."""
