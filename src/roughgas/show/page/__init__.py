"""What is made to be looked at in a browser: the interactive page, and documents for the report."""
