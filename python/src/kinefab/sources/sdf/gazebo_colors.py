"""Materials that Gazebo has by itself and models name in a ``<script>``, as far as they are a colour.

Source: ``media/materials/scripts/gazebo.material`` of Gazebo 11, the diffuse colours.
"""

from __future__ import annotations

GAZEBO_COLORS = {
    f"Gazebo/{name}": rgba
    for name, rgba in {
        "Grey": (0.7, 0.7, 0.7, 1.0),
        "DarkGrey": (0.175, 0.175, 0.175, 1.0),
        "White": (1.0, 1.0, 1.0, 1.0),
        "FlatBlack": (0.1, 0.1, 0.1, 1.0),
        "Black": (0.0, 0.0, 0.0, 1.0),
        "Red": (1.0, 0.0, 0.0, 1.0),
        "RedBright": (0.87, 0.26, 0.07, 1.0),
        "Green": (0.0, 1.0, 0.0, 1.0),
        "Blue": (0.0, 0.0, 1.0, 1.0),
        "SkyBlue": (0.0, 0.0, 1.0, 1.0),
        "Yellow": (1.0, 1.0, 0.0, 1.0),
        "ZincYellow": (0.9725, 0.9529, 0.2078, 1.0),
        "Purple": (1.0, 0.0, 1.0, 1.0),
        "Turquoise": (0.0, 1.0, 1.0, 1.0),
        "Orange": (1.0, 0.5088, 0.0468, 1.0),
        "Gold": (0.8, 0.64869, 0.120759, 1.0),
        "RedTransparent": (1.0, 0.0, 0.0, 0.5),
        "GreenTransparent": (0.0, 1.0, 0.0, 0.5),
        "BlueTransparent": (0.0, 0.0, 1.0, 0.5),
        "GreyTransparent": (0.5, 0.5, 0.5, 0.5),
        "YellowTransparent": (1.0, 1.0, 0.0, 0.5),
    }.items()
}
"""RGBA as the screen has it, by the script's name."""
