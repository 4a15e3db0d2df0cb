"""A CAD bundle by hand: begun from a folder of meshes, and looked over."""
