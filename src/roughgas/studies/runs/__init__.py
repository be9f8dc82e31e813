"""What the tasks of studies simulate, a file for each study: these alone need the kernel."""
