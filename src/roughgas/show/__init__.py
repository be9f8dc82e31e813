"""Presentation: figures, movies, and HTML pages."""
