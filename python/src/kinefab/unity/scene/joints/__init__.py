"""Joints, one a file."""
