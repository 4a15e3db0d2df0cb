"""Autodesk Fusion, by an add-in in its own Python."""
