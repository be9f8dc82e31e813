"""What people look at: figures, movies, and the interactive page."""
