"""From points to results: reduced datasets, tables, costs, and a run packed for others."""
