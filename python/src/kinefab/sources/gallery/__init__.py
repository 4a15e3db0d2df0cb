"""Assemblies as the Fusion 360 Gallery dataset has them: ``assembly.json`` and a mesh for each body beside it."""
