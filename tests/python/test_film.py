"""Pictures by depth, and pictures that move."""

from __future__ import annotations

import importlib.util
import re
import xml.etree.ElementTree as ElementTree
from io import BytesIO
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from command_line import run
from kinefab import filming
from kinefab.filming import film
from kinefab.views.camera import View
from kinefab.views.raster.fragments import fragments, nearest_last
from kinefab.views.raster.image import Canvas, png
from kinefab.views.raster.solid import solid

ROOT = Path(__file__).parents[2]
LEVER = ROOT / "fixtures" / "lever" / "lever.kinefab"
BUNDLE = LEVER.with_name("lever.bundle.json")
FRONT = View(np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, 1.0]), 40.0, np.zeros(3), 200, 200)
with_pillow = pytest.mark.skipif(
    importlib.util.find_spec("PIL") is None, reason="no Pillow: GIF and WebP are not tried"
)


def square(z, size=1.0):
    corners = size * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float) + [0, 0, z]
    return corners[np.array([[0, 1, 2], [0, 2, 3]])]


def test_fragments_cover_just_the_pixels_whose_middle_is_inside():
    flat = np.array([[[10.0, 10.0], [30.0, 10.0], [10.0, 30.0]]])
    (found,) = fragments(flat, np.array([[0.0, 1.0, 2.0]]), 40, 40)
    y, x = np.divmod(found.pixel, 40)
    yy, xx = np.mgrid[:40, :40]
    inside = (xx + 0.5 >= 10) & (yy + 0.5 >= 10) & (xx + yy + 1 <= 40)
    assert set(zip(x.tolist(), y.tolist())) == set(zip(xx[inside].tolist(), yy[inside].tolist()))
    assert found.depth == pytest.approx((x + 0.5 - 10) / 20 + 2 * (y + 0.5 - 10) / 20)


def covered(flat, width, height):
    """Triangle by triangle: the pixels of the box around it whose weights are none below zero."""
    found = []
    for number, corners in enumerate(flat):
        edge_u, edge_v = corners[1] - corners[0], corners[2] - corners[0]
        twice = edge_u[0] * edge_v[1] - edge_u[1] * edge_v[0]
        if abs(twice) > 1e-9:
            y, x = np.mgrid[:height, :width]
            away_x, away_y = x + 0.5 - corners[0, 0], y + 0.5 - corners[0, 1]
            b = (away_x * edge_v[1] - away_y * edge_v[0]) / twice
            c = (edge_u[0] * away_y - edge_u[1] * away_x) / twice
            box = np.all(np.stack([x, y]) >= np.ceil(corners.min(axis=0) - 0.5)[:, None, None], axis=0)
            box &= np.all(np.stack([x, y]) <= np.floor(corners.max(axis=0) - 0.5)[:, None, None], axis=0)
            inside = box & (b >= -1e-9) & (c >= -1e-9) & (b + c <= 1.0 + 1e-9)
            pixels = np.flatnonzero(inside)
            found += zip([number] * len(pixels), pixels.tolist(), b[inside].tolist(), c[inside].tolist())
    return found


@pytest.mark.parametrize("kind", ["any", "thin", "flat", "on the grid", "beyond"])
def test_lines_of_pixels_are_tried_where_the_triangle_is_and_none_is_missed(kind):
    """The same pixels in the same order as by the whole box around each, with the same bits, also where rounding decides."""
    random = np.random.default_rng(7)
    flat = random.uniform(-6.0, 46.0, (150, 3, 2))
    if kind == "thin":
        share = random.uniform(size=(150, 1))
        flat[:, 2] = flat[:, 0] + share * (flat[:, 1] - flat[:, 0]) + random.normal(size=(150, 2)) * 1e-2
        flat[75:, 2] += random.normal(size=(75, 2)) * 1e-7 - (flat[75:, 2] - flat[75:, 0]) * 0.5
    elif kind == "flat":
        flat[:, 1, 1] = flat[:, 0, 1] + random.choice([0.0, 1e-14, 1e-9, 1e-6], 150)
    elif kind == "on the grid":
        flat = np.round(flat * 2.0) / 2.0
    elif kind == "beyond":
        flat *= 1e5
    pieces = list(fragments(flat, np.zeros((150, 3)), 40, 36))
    got = [
        entry
        for piece in pieces
        for entry in zip(
            piece.triangle.tolist(),
            piece.pixel.tolist(),
            piece.weight[:, 1].tolist(),
            piece.weight[:, 2].tolist(),
        )
    ]
    assert got == covered(flat, 40, 36) and len(got) > 5


def test_what_is_nearer_is_drawn_later_whatever_its_middle():
    """A long plate, near at one end: by the middles it would go behind what it covers."""
    small, plate = square(0.0, 0.3), square(0.0, 1.0)
    small = small + [0.8, 0.0, 0.3]
    tilted = plate * [3.0, 1.0, 1.0] + plate[..., :1] * [
        0.0,
        0.0,
        3.0,
    ]  # its middle is behind, its end before
    triangles = np.concatenate([tilted, small])
    flat = FRONT.project(triangles.reshape(-1, 3)).reshape(-1, 3, 2)
    order = nearest_last(flat, triangles[..., 2], 200, 200, 1e-6).tolist()
    assert triangles[:2, :, 2].mean() < triangles[2:, :, 2].mean()
    assert 2 not in order and 3 not in order  # wholly hidden
    shown = nearest_last(flat, -triangles[..., 2], 200, 200, 1e-6).tolist()
    assert max(shown.index(2), shown.index(3)) > shown.index(min(shown[0], 1))


def test_triangles_that_overlap_in_a_circle_are_all_drawn():
    bars = []
    for k in range(3):
        angle = 2 * np.pi * k / 3
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        bars.append(np.array([[-1.5, 0.3, -0.5], [1.5, 0.3, 0.5], [1.5, 0.6, 0.5]]) @ turn.T)
    triangles = np.array(bars)
    flat = FRONT.project(triangles.reshape(-1, 3)).reshape(-1, 3, 2)
    assert sorted(nearest_last(flat, triangles[..., 2], 200, 200, 1e-6).tolist()) == [0, 1, 2]


def box():
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return solid(corners, faces, np.full((12, 3), 0.5))


def test_a_box_has_its_twelve_edges_and_flat_sides():
    shape = box()
    assert shape.sharp.shape == (12, 2, 3) and len(shape.smooth) == 6
    assert np.abs(shape.normals - shape.facing[:, None]).max() < 1e-12


def test_hidden_edges_are_not_drawn():
    """A box seen from the front: four edges, and nothing of the ones behind its face."""
    canvas = Canvas(FRONT, 200, 200)
    canvas.surfaces(box())
    before = canvas.pixels()
    canvas.edges(box())
    changed = np.any(canvas.pixels() != before, axis=2)
    assert changed[100, 58:63].any() and not changed[65:135, 65:135].any()


def test_png_reads_back():
    pixels = np.random.default_rng(3).integers(0, 256, (5, 7, 3)).astype(np.uint8)
    image = pytest.importorskip("PIL.Image", reason="no Pillow: a PNG is not read back")
    assert (np.asarray(image.open(BytesIO(png(pixels)))) == pixels).all()


@with_pillow
def test_the_lever_s_gif_moves_and_comes_round():
    from PIL import Image

    first = film(LEVER, ".gif")
    picture = Image.open(BytesIO(first))
    frames = []
    for i in range(picture.n_frames):
        picture.seek(i)
        frames.append(np.asarray(picture.convert("RGB"), dtype=float))
    steps = [np.abs(a - b).mean() for a, b in zip(frames, [*frames[1:], frames[0]])]
    assert len(frames) == 40 and min(steps) > 0.2 and max(steps) < 3.0 * np.median(steps)
    assert film(LEVER, ".gif") == first


def test_the_moving_svg_shows_one_frame_at_a_time():
    scene = kinefab.Scene()
    base = scene.add_part("<Base> & more", grounded=True)
    arm = scene.add_part("Arm", translation=(0, 0.1, 0))
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 0, 1), limits=(-10, 80), name="Hinge")
    text = film(scene, ".svg").decode("utf-8")
    root = ElementTree.fromstring(text)
    images = [e for e in root if e.tag.endswith("image")]
    assert len(images) == 40 and [e.get("display") for e in images].count("inline") == 1
    for i, image in enumerate(images):
        (animate,) = image
        times = [float(t) for t in animate.get("keyTimes").split(";")]
        values = animate.get("values").split(";")
        assert len(times) == len(values) and times[0] == 0.0 and values.count("inline") == 1
        assert times[values.index("inline")] == pytest.approx(i / 40, abs=1e-5)


@pytest.mark.parametrize("length", [0.004, 40.0])
def test_a_slide_without_ends_goes_as_far_as_what_is_seen_is_long(monkeypatch, length):
    """Parts that CAD drew in place all have their origin in one point: their meshes tell how long the machine is."""
    scene = kinefab.Scene()
    bed = scene.add_part("Bed", trimesh.creation.box(length * np.array([1.0, 0.1, 0.2])), grounded=True)
    ram = scene.add_part("Ram", trimesh.creation.box(length * np.array([0.2, 0.3, 0.2])), density=1000)
    scene.add_slider(bed, ram, point=(0, 0, 0), axis=(1, 0, 0), name="Slide")
    places: list[list[float]] = []

    def heard(document, buffers, frames, progress):
        places.extend([position for _, position, _ in frame] for frame in frames)
        return []

    monkeypatch.setattr(filming, "pictures", heard)
    monkeypatch.setattr(filming, "animated_svg", lambda images, title: b"")
    film(scene, ".svg")
    assert np.ptp(np.array(places), axis=0).max() == pytest.approx(length, rel=1e-3)


def test_a_source_is_drawn_as_its_scene_is_and_moves_only_when_asked(tmp_path):
    kinefab.export(BUNDLE, tmp_path / "lever.kinefab")
    for source, name in ((BUNDLE, "source.svg"), (tmp_path / "lever.kinefab", "scene.svg")):
        assert run("draw", source, "-o", tmp_path / name).returncode == 0
    assert (tmp_path / "source.svg").read_bytes() == (tmp_path / "scene.svg").read_bytes()
    assert run("draw", BUNDLE, "--motion", "-o", tmp_path / "moving.svg").returncode == 0
    assert b"<animate" in (tmp_path / "moving.svg").read_bytes()


@pytest.mark.parametrize(
    "arguments", [["x.png", "--motion"], ["x.png", "--joint", "Shaft"], ["x.svg", "--joint", "Shaft"]]
)
def test_what_is_said_of_a_motion_is_refused_for_a_picture_that_stands_still(tmp_path, arguments):
    done = run("draw", LEVER, "-o", *arguments, cwd=tmp_path)
    assert done.returncode == 2 and arguments[1] in done.stderr and "--motion" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "says"), [(["--joint", "Nothing"], "no coordinate"), (["-o", "x.bmp"], ".webp")]
)
def test_wrong_calls_are_refused(tmp_path, arguments, says):
    done = run("draw", LEVER, "--motion", "-o", tmp_path / "x.svg", *arguments, cwd=tmp_path)
    assert done.returncode == 2 and says in re.sub(r"[\s│]+", " ", done.stderr)
