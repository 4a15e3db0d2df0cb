"""What readers of robots share (URDF, SDF, MJCF): packages, links and what holds them together, shapes, masses, XML."""
