"""Everything that knows Unity: the one mirror, joint components, the scene document and its writer."""
