"""The figures of what accuracy costs."""
