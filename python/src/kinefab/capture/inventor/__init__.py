"""Autodesk Inventor, over COM."""
