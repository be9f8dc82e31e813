"""The event-driven simulation itself: compiled, deterministic, ignorant of files and workflows."""
