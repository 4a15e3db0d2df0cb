"""From joints of the model to Unity's components."""
