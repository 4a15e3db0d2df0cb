"""The picture of a scene."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ElementTree

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab import filming
from kinefab.views import overview, picture
from kinefab.views.bars import COLOURS, bars
from kinefab.views.camera import looking
from kinefab.views.freedoms import world_placements
from kinefab.views.raster import film
from kinefab.views.raster.film import pictures
from kinefab.views.seen import shown

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


def test_a_mesh_is_drawn_at_the_scale_of_its_object():
    """The square twice as high and three times as wide, and mirrored with its outside still outside; in both kinds of picture."""
    (scene, [data]), (wide, _) = document([0, 3, 2, 0, 2, 1]), document([0, 3, 2, 0, 2, 1])
    far = (SQUARE * np.array([3, 2, 1], "<f4")).astype("<f4").tobytes() + data[48:]
    wide["gameObjects"][0]["transform"] = {"localScale": [3, 2, 1]}
    assert picture.draw(wide, [data]) == picture.draw(scene, [far]) != picture.draw(scene, [data])
    images = [
        pictures(d, [b], [world_placements(d["gameObjects"])])[0]
        for d, b in ((wide, data), (scene, far), (scene, data))
    ]
    assert (images[0] == images[1]).all() and (images[0] != images[2]).any()
    wide["gameObjects"][0]["transform"] = {"localScale": [-3, 2, 1]}
    assert surfaces(picture.draw(wide, [data])) == surfaces(picture.draw(scene, [far])) > 0


def test_what_is_not_shown_in_unity_is_not_drawn():
    """A renderer that is off, and a mesh below an object that is not active, as a suppressed part with several bodies has it."""
    scene, buffers = document([0, 3, 2, 0, 2, 1])
    [square] = scene["gameObjects"]
    off = {**square, "components": [square["components"][0], {"type": "MeshRenderer", "enabled": False}]}
    below = [{"id": "P", "name": "P", "active": False}, {**square, "parent": 0}]
    for objects in ([off], below):
        hidden = {**scene, "gameObjects": objects}
        [image] = pictures(hidden, buffers, [world_placements(objects)])
        assert surfaces(picture.draw(hidden, buffers)) == 0 and (image == 255).all()
        assert shown(objects) == [False] * len(objects)


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
    scene, buffers = document([0, 3, 2])
    placements = [world_placements(scene["gameObjects"])]
    [triangle] = pictures(scene, buffers, placements)
    monkeypatch.setattr(film, "MOST_TRIANGLES", 0)
    [box] = pictures(scene, buffers, placements)
    assert (box < 255).any(axis=2).sum() > 1.5 * (triangle < 255).any(axis=2).sum() > 0


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


def chain(mesh: bool = False, z: float = 0.3) -> kinefab.Scene:
    """A post and three links, hinged at heights of 0.1, 0.3 and 0.7 m; the last one ends at nothing."""
    scene = kinefab.Scene()
    below = scene.add_part("Post", grounded=True)
    for i, height in enumerate((0.1, 0.3, 0.7)):
        shape = trimesh.creation.box((0.02, 0.1, 0.02)) if mesh else None
        link = scene.add_part(f"Link {i}", shape, translation=(0.2, height + 0.05, z))
        scene.add_hinge(
            below, link, point=(0.2, height, z), axis=(0, 0, 1), limits=(-10, 80), name=f"Pin {i}"
        )
        below = link
    return scene


def test_bodies_without_a_mesh_are_bars_between_their_joints(tmp_path):
    """Of a robot whose meshes are missing only the joints' signs hung in the air."""
    written = json.loads(kinefab.export(chain(), tmp_path / "chain.kinefab").path.read_text())
    placements = world_placements(written["gameObjects"])
    found = [ends @ placements[i][0].T + placements[i][1] for i, _, ends in bars(written["gameObjects"])]
    mirrored = [[(-0.2, 0.1, 0.3), (-0.2, 0.3, 0.3)], [(-0.2, 0.3, 0.3), (-0.2, 0.7, 0.3)]]
    assert len(found) == 2 and np.allclose([sorted(ends.tolist()) for ends in found], mirrored, atol=1e-6)
    assert len({colour for _, colour, _ in bars(written["gameObjects"])}) == 2
    assert picture.draw(written, []).count('stroke-width="9"') == 2
    solid = kinefab.export(chain(mesh=True), tmp_path / "solid.kinefab").path
    assert bars(json.loads(solid.read_text())["gameObjects"]) == []


def test_bars_go_with_their_bodies_in_a_film(tmp_path):
    grey = np.array([int(COLOURS[1][k : k + 2], 16) for k in (1, 3, 5)])
    kept: list[np.ndarray] = []

    def seen(images, _):
        kept.extend(images)
        return b""

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("kinefab.filming.animated_svg", seen)
        filming.film(chain(), ".svg", "Pin 1")
    shown = [(np.abs(image.astype(int) - grey).max(axis=2) < 3) for image in kept]
    assert (
        all(image.sum() > 200 for image in shown)
        and (shown[0] & shown[len(shown) // 2]).sum() < shown[0].sum() / 2
    )


def test_a_picture_bears_the_scene_s_name_and_counts_one_as_one(tmp_path):
    scene = kinefab.Scene()
    scene.add_part("Block", trimesh.creation.box((0.1, 0.2, 0.3)))
    text = " ".join(
        ElementTree.fromstring(
            overview.picture(kinefab.export(scene, tmp_path / "block.kinefab").path)
        ).itertext()
    )
    assert "block" in text and "1 object, 0 joints, mobility 6" in text
