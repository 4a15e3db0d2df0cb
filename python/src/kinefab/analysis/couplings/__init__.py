"""Relations between joint coordinates: gears and their like, and symmetry."""
