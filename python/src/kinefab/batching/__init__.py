"""Thousands at once: each source in a process of its own, on this machine or on many, skipping what is up to date."""
