"""Where a simulation could go wrong: a catalogue of hard cases, one test module a family.

Each test is a case. It says what could go wrong, measures how far it stays from that (see
catalogue.py), and is one row or more of the table that `snakemake hard_cases` makes.
"""
