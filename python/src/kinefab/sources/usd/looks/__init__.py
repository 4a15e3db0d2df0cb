"""What is drawn: triangles of meshes and gprims, surfaces and their textures."""
