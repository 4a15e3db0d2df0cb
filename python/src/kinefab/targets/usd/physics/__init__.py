"""Bodies, colliders, joints: UsdPhysics, and vendors' attributes by name."""
