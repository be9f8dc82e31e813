"""Scenes run and measured: one point of an experiment from its settings to its numbers."""
