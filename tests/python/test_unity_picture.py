"""The picture of a scene."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from kinefab.views import picture
from kinefab.views.camera import looking

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4")


def document(triangles: list[int], **joint: object) -> tuple[dict, list[bytes]]:
    """One square in the plane z = 0 with a joint, and its buffer."""
    data = SQUARE.tobytes() + np.array(triangles, "<u2").tobytes()
    mesh = {
        "name": "Square",
        "vertexCount": 4,
        "bounds": {"center": [0.5, 0.5, 0], "extents": [0.5, 0.5, 0.01]},
        "positions": {"buffer": 0, "offset": 0},
        "indexFormat": "uint16",
        "indices": {"buffer": 0, "offset": 48},
        "submeshes": [{"indexStart": 0, "indexCount": len(triangles)}],
    }
    components = [{"type": "MeshFilter", "mesh": 0}, {"type": "MeshRenderer", "materials": []}]
    if joint:
        components.append(joint)
    objects = [{"id": "A", "name": "A & B", "components": components}]
    return {"gameObjects": objects, "meshes": [mesh]}, [data]


def surfaces(svg: str) -> int:
    return len(re.findall("Z", "".join(re.findall(r'<path d="([^"]*)"', svg))))


def test_only_the_side_that_faces_the_viewer_is_drawn():
    """The viewer stands on the -Z side; Unity's clockwise winding faces it, the other does not."""
    assert surfaces(picture.draw(*document([0, 3, 2, 0, 2, 1]))) > 0
    assert surfaces(picture.draw(*document([0, 2, 3, 0, 1, 2]))) == 0


def test_right_stays_right_in_the_left_handed_frame():
    """A viewer on the -Z side sees +X on the right and +Y above."""
    view = looking(np.array([[0.0, 0, 0], [1, 1, 1]]), np.zeros((0, 3)), 760, 560, 60)
    origin, along_x, along_y = view.project(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]))
    assert along_x[0] > origin[0]
    assert along_y[1] < origin[1]


def test_a_hinge_is_told_with_its_limits():
    """The legend names the joint, escaped, and its range."""
    svg = picture.draw(
        *document(
            [0, 3, 2], type="HingeJoint", axis=[0, 0, 1], useLimits=True, limits={"min": -10, "max": 80}
        )
    )
    text = " ".join(ElementTree.fromstring(svg).itertext())
    assert "A & B" in text and "turn X -10 .. 80 deg" in text


def test_a_slide_is_told_as_inspect_tells_it():
    """A Limited linear axis is drawn around the connected anchor and named with its range from the pose in the file."""
    svg = picture.draw(
        *document(
            [0, 3, 2],
            type="ConfigurableJoint",
            axis=[1, 0, 0],
            connectedAnchor=[0.2, 0, 0],
            xMotion="Limited",
            linearLimit={"limit": 0.045},
            **{
                m: "Locked"
                for m in ("yMotion", "zMotion", "angularXMotion", "angularYMotion", "angularZMotion")
            },
        )
    )
    assert "slide X -0.045 .. 0.045 m" in " ".join(ElementTree.fromstring(svg).itertext())


def test_a_scene_of_too_many_triangles_is_drawn_as_boxes(monkeypatch: pytest.MonkeyPatch):
    """Above the limit each body becomes its box, so that the picture stays small."""
    monkeypatch.setattr(picture, "MAX_TRIANGLES", 1)
    assert surfaces(picture.draw(*document([0, 3, 2, 0, 2, 1]))) == 6


def test_the_same_scene_gives_the_same_picture():
    """No clock and no random numbers."""
    assert picture.draw(*document([0, 3, 2])) == picture.draw(*document([0, 3, 2]))


def test_only_joints_that_the_legend_lists_are_numbered():
    """Each number in the drawing stands in the legend too, and the rest is counted there."""
    scene, buffers = document([0, 3, 2])
    scene["gameObjects"][0]["components"] += [
        {"type": "HingeJoint", "anchor": [0.1 * i, 0, 0]} for i in range(25)
    ]
    texts = [t.strip() for t in ElementTree.fromstring(picture.draw(scene, buffers)).itertext()]
    assert [texts.count(str(number)) for number in range(1, 26)] == [2] * 18 + [0] * 7
    assert "and 7 more" in texts


def test_text_of_the_file_stays_text():
    """Neither markup nor control characters of a scene become the picture's own."""
    scene, buffers = document([0, 3, 2], type="HingeJoint")
    scene["gameObjects"][0]["name"], scene["source"] = "a\x1b\ud800<b>", {"uri": "<c>\0"}
    scene["analysis"] = {"mobility": "</text><script>"}
    svg = picture.draw(scene, buffers)
    text = " ".join(ElementTree.fromstring(svg.encode("utf-8")).itertext())
    assert all(words in text for words in ("a\\x1b\\ud800<b>", "<c>\\x00", "mobility </text><script>"))
