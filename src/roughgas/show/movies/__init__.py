"""A point seen as it moves: its trajectory, frame by frame, and how it is drawn."""
