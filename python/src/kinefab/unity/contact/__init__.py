"""Who collides with whom: pairs that are kept apart after mapping, and colliders that overlap at the start."""
