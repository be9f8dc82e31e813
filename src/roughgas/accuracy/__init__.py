"""What accuracy costs in time: studies of the error of R against CPU seconds."""
