"""The way back: from a written scene to the model."""
