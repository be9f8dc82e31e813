"""A safety net for rebuilds: outputs that depend on settings, recorded before and compared after.

`python -m tests.net record FOLDER` writes a JSON file for each of RECORDERS (see recorders.py), a
text for each item; `python -m tests.net compare FOLDER` makes them again and prints differences.
"""
