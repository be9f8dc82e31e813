"""Datasets: what files hold, how they are written and read."""
