"""What every room may use: errors, whole files, the version, the machine."""
