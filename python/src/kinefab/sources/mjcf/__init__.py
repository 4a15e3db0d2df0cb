"""MJCF: MuJoCo's models, read by MuJoCo itself (MjSpec), so that defaults, includes and inertias are those it resolves."""
