"""GameObjects and components as documents of a prefab."""
