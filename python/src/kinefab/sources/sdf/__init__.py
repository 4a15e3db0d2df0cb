"""SDF 1.4 to 1.12: what Gazebo describes models and worlds with; a graph of joints, loops included."""
