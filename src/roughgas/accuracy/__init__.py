"""What accuracy costs: errors of R against CPU seconds, from every source of error."""
