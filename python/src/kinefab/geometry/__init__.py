"""Triangles: reading mesh files, matching them to bodies, mass properties and collision hulls."""
