"""Building a scene in a script: parts from meshes, joints between them, couplings between joints.

    lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0))
    scene.add_hinge(box, lid, point=(0, 0.2, -0.15), axis=(1, 0, 0), limits=(0, 110))

Positions are world positions of the exported pose, right-handed, +Y up, +Z forward, metres and degrees.
"""

from .scene import Scene

__all__ = ["Scene"]
