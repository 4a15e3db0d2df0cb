"""URDF and xacro: what ROS describes robots with."""
