"""What UsdPhysics and vendors state: colliders, masses, joints, couplings, collision filters."""
