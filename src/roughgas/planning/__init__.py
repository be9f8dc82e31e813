"""Accuracy on demand: from a wanted standard error of R to run lengths and seeds, with their cost.

A short pilot run of each point measures how fast the gas equilibrates, how long R remembers, how
much it scatters and what a simulated time costs (steady.py and cooling.py, one for each kind of
schedule). From these follow the lengths of a run, the number of seeds that the target needs, and
what all that will cost (plan.py). The point is then run until it meets the target (reach.py).
"""
