"""How an experiment is run and measured: one file a kind of schedule."""
