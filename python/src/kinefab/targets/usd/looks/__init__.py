"""What is drawn: meshes, materials, textures."""
