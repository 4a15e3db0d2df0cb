"""glTF 2.0 in one binary file: right-handed, +Y up, metres, so nothing is mirrored.

Physics in the draft extensions KHR_physics_rigid_bodies and KHR_implicit_shapes, as Godot, Babylon.js and Blender's add-on
read them; a program that knows neither sees the hierarchy, the meshes, the materials and the clips.
"""

from .glb import write

__all__ = ["write"]
