"""The event-driven simulation itself: compiled, deterministic, ignorant of files and workflows."""

from roughgas.kernel import cache

cache.use_source_keyed_folder()
