"""Mesh files of parts that trimesh does not read: exact ones by OpenCASCADE, others by assimp, each in a process of its own."""
