"""Meshes, materials and clips in Unity's frame."""
