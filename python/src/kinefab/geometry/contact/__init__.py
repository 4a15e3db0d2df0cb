"""Shapes that touch: convex pieces of hollow ones, and how deep two of them overlap."""
