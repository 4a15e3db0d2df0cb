"""Colliders, one a file."""
