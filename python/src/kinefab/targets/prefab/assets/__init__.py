"""Files that a prefab refers to: meshes, materials, textures, clips."""
