"""Kinefab: carries mechanisms out of CAD into Unity, moving as they moved in CAD."""

__version__ = "0.1.0"
