"""Drives a mechanism: pose after pose at stated joint coordinates, each block by itself."""
