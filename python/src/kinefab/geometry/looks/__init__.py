"""How bodies look: surfaces, textures and colours of what trimesh read, and normals where a source has none."""
