"""The whole assembly: duplicates told, poses closed, bodies merged, blocks split."""
