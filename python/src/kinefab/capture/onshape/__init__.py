"""Onshape, over its REST API or from saved answers of it."""
