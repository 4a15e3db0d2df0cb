"""Wavefront OBJ: its text as tables of numbers, and those as bodies with surfaces."""
