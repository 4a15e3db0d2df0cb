"""The page as a file: one, self-contained, the same every time, and never half written."""

from __future__ import annotations

import json
import re
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from command_line import run
from kinefab.views.page.blob import Blob
from kinefab.views.page.meshes import MOST_TRIANGLES, packed_meshes
from kinefab.views.page.page import script_safe
from linkages import ring

ROOT = Path(__file__).parents[2]
LEVER = ROOT / "fixtures" / "lever" / "lever.kinefab"


@pytest.fixture(scope="module")
def lever(tmp_path_factory):
    return kinefab.view(LEVER, tmp_path_factory.mktemp("page") / "lever.html").read_text("utf-8")


def test_the_page_is_one_small_file_that_fetches_nothing(lever):
    """Below 1.5 MB; no address but those of licences and XML namespaces in the library."""
    assert len(lever.encode("utf-8")) < 1_500_000
    tags = re.sub(r"<script>.*?</script>", "", lever, flags=re.DOTALL)
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!data:)", tags)
    assert (
        "default-src 'none'" in lever and "@import" not in lever and "url(" not in lever.split("<script")[0]
    )


def test_the_same_scene_makes_the_same_page(lever, tmp_path):
    assert kinefab.view(LEVER, tmp_path / "again.html").read_text("utf-8") == lever


def test_a_source_s_page_is_that_of_its_scene(tmp_path):
    """What is shown is what is exported: the bundle's page is the written scene's, the joints named as in CAD."""
    bundle = ROOT / "fixtures" / "lever" / "lever.bundle.json"
    written = kinefab.export(bundle, tmp_path / "lever.kinefab").path
    one, other = (kinefab.view(s, tmp_path / "lever.html").read_text("utf-8") for s in (bundle, written))
    assert one == other
    assert "Shaft" in described(one)["coordinates"]


def described(text):
    return json.loads(
        re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL).group(1)
    )


def test_nothing_in_a_name_ends_the_script():
    evil = "</script><!--<script>&\u2028"
    assert not re.search(r"[<>&\u2028]", script_safe({"name": evil}))
    assert json.loads(script_safe({"name": evil})) == {"name": evil}


def test_names_that_look_like_places_of_the_template_stay(tmp_path):
    scene = kinefab.Scene()
    scene.add_part("%CODE% %DATA%", grounded=True)
    text = kinefab.view(scene, tmp_path / "page.html").read_text("utf-8")
    assert "%CODE% %DATA%" in [part["name"] for part in described(text)["parts"]]


def grid(n):
    """A flat square of 2 n n triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 2, n + 1))
    corners = np.column_stack([x.ravel(), y.ravel(), np.zeros((n + 1) ** 2)]).astype("<f4")
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + n + 2], 1), np.stack([i, i + n + 2, i + n + 1], 1)])
    return corners, faces.astype("<u4")


def test_more_triangles_than_a_page_carries_are_thinned_and_counted(monkeypatch):
    monkeypatch.setattr("kinefab.views.page.meshes.MOST_TRIANGLES", 2_000)
    corners, faces = grid(100)
    mesh = {"vertexCount": len(corners), "positions": {"buffer": 0, "offset": 0}, "indexFormat": "uint32"}
    mesh |= {"indices": {"buffer": 0, "offset": corners.nbytes}, "name": "grid"}
    mesh |= {"submeshes": [{"indexStart": 0, "indexCount": faces.size}]}
    (entry,), (total, kept) = packed_meshes(
        {"meshes": [mesh]}, [corners.tobytes() + faces.tobytes()], [0], Blob()
    )
    assert total == 20_000 and 200 < kept <= 2_500 and MOST_TRIANGLES > 1_000_000
    assert entry["span"][:2] == pytest.approx([1.0, 2.0])


def test_scenes_with_nothing_to_show_have_a_page(tmp_path):
    """Empty, or without joints: a page that says so."""
    scene = kinefab.Scene()
    scene.add_part("Lonely", grounded=True)
    page = described(kinefab.view(scene, tmp_path / "page.html").read_text("utf-8"))
    assert page["coordinates"] == {} and page["joints"] == []
    empty = tmp_path / "empty.kinefab"
    empty.write_text('{"format": "kinefab.scene", "version": "1.0", "gameObjects": []}', "utf-8")
    assert described(kinefab.view(empty, tmp_path / "empty.html").read_text("utf-8"))["parts"] == []


@pytest.mark.parametrize("direction", ["X", "Y", "Z"])
def test_a_capsule_lies_along_its_direction(tmp_path, direction):
    """Robots have many; a page was refused for one."""
    capsule = {
        "type": "CapsuleCollider",
        "radius": 0.1,
        "height": 0.5,
        "direction": direction,
        "center": [1, 2, 3],
    }
    scene = {"format": "kinefab.scene", "version": "1.0"}
    scene |= {"gameObjects": [{"id": "a", "name": "a", "components": [{"type": "Rigidbody"}, capsule]}]}
    path = tmp_path / "capsule.kinefab"
    path.write_text(json.dumps(scene), "utf-8")
    (part,) = described(kinefab.view(path, tmp_path / "page.html").read_text("utf-8"))["parts"]
    (shape,) = part["colliders"]
    assert (shape["kind"], shape["radius"], shape["height"]) == ("capsule", 0.1, 0.5)
    at = np.reshape(shape["at"], (3, 4))
    assert np.abs(at[:, 1]) == pytest.approx(np.eye(3)["XYZ".index(direction)])
    assert np.abs(at[:, 3]) == pytest.approx([1, 2, 3])


BROKEN = {
    "JSON_SYNTAX": "{",
    "FORMAT_UNKNOWN": '{"format": "another"}',
    "FIELD_MISSING": '{"format": "kinefab.scene", "version": "1.0"}',
    "JOINT_AXIS_ZERO": json.dumps(
        {
            "format": "kinefab.scene",
            "version": "1.0",
            "gameObjects": [
                {
                    "id": "a",
                    "name": "a",
                    "components": [{"type": "Rigidbody"}, {"type": "HingeJoint", "axis": [0, 0, 0]}],
                }
            ],
        }
    ),
    "VALUE_NOT_ALLOWED": json.dumps(
        {
            "format": "kinefab.scene",
            "version": "1.0",
            "gameObjects": [
                {
                    "id": "a",
                    "name": "a",
                    "components": [
                        {"type": "Rigidbody"},
                        {"type": "ConfigurableJoint", "xMotion": "Perhaps"},
                    ],
                }
            ],
        }
    ),
}


@pytest.mark.parametrize("code, text", BROKEN.items(), ids=BROKEN)
def test_a_broken_scene_is_refused_in_a_sentence(code, text, tmp_path):
    path, page = tmp_path / "broken.kinefab", tmp_path / "page.html"
    path.write_text(text, "utf-8")
    page.write_text("old", "utf-8")
    done = run("view", path, "-o", page)
    assert done.returncode == 1 and code in done.stderr and "Traceback" not in done.stderr
    assert page.read_text("utf-8") == "old"


@pytest.mark.parametrize("written", [kinefab.view, kinefab.report], ids=["view", "report"])
@pytest.mark.parametrize(
    "wrong, told",
    [
        ({"source": 3}, "the source is 3; pass a file's path or a kinefab.Scene"),
        ({"target": None}, "the target is None; pass the path of the page, NAME.html"),
        ({"options": {"limits": True}}, "the options are {'limits': True}; pass kinefab.ExportOptions(...)"),
    ],
)
def test_what_is_no_source_target_or_options_is_a_wrong_call(written, wrong, told, tmp_path):
    with pytest.raises(TypeError) as refused:
        written(**({"source": kinefab.Scene(), "target": tmp_path / "a.html"} | wrong))
    assert str(refused.value) == told


def test_a_target_that_cannot_be_written_is_named(tmp_path):
    done = run("view", LEVER, "-o", tmp_path / "nowhere" / "page.html")
    assert done.returncode == 1 and "TARGET_UNWRITABLE" in done.stderr
    done = run("view", LEVER, "-o", tmp_path / "page.txt")
    assert done.returncode == 2 and ".html" in done.stderr
    assert run("view", tmp_path / "missing.kinefab").returncode == 1


def test_a_report_tells_and_plots_what_moves(tmp_path):
    """The lever: its crank goes round, its slider has a stroke of twice the eccentricity, at most dx/dq as in closed form."""
    bundle = ROOT / "fixtures" / "lever" / "lever.bundle.json"
    options = kinefab.ExportOptions(colliders="none")  # those need a library to be kept whole
    text = kinefab.report(bundle, tmp_path / "report.html", options).read_text("utf-8")
    words = text[text.index('<article id="words">') : text.index("</article>")]
    assert "moves in 1 way, by 4 joints, 1 of which closes a loop" in words
    assert "it turns all the way round" in words and "a stroke of 0.05 m" in words
    assert words.count("<polyline") == 6 and words.count("<figure>") == 4
    assert re.search(r"\d+ kept, 0 approximated, 0 dropped", words)


def test_a_report_s_reach_ends_at_limits_and_dead_points():
    from kinefab.showing import reach_of

    scene = kinefab.Scene()
    base, arm = scene.add_part("Base", grounded=True), scene.add_part("Arm")
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 0, 1), limits=(-10, 80), name="Hinge")
    low, high, words = reach_of(kinefab.motion(scene), "Hinge", 1.0)
    assert (low, high) == (pytest.approx(-10), pytest.approx(80)) and words == ("its limit", "its limit")
    rocker = kinefab.motion(ROOT / "fixtures" / "mechanisms" / "M03.kinefab")
    low, high, words = reach_of(rocker, rocker.freedoms[0].name, 1.0)
    assert high - low == pytest.approx(2 * 94.0960437582, abs=0.01) and words == (
        "a dead point",
        "a dead point",
    )


def test_a_report_says_where_another_motion_branches_off(tmp_path):
    pins = [np.array(pin) for pin in ((0.0, 0.0, 0.0), (0.0, 0.1, 0.0), (0.25, 0.1, 0.0), (0.25, 0.0, 0.0))]
    parallelogram = ring(pins, ["base", "crank", "coupler", "rocker"])
    words = kinefab.report(parallelogram, tmp_path / "report.html").read_text("utf-8")
    found = re.search(r"At (\S+), (\S+) degrees another motion branches off", words)
    assert found and sorted(abs(float(x)) for x in found.groups()) == pytest.approx([90.0, 270.0], abs=0.01)


def test_names_in_a_report_stay_text(tmp_path):
    scene = kinefab.Scene()
    evil = "<script>alert(1)</script>"
    base, arm = scene.add_part(evil, grounded=True), scene.add_part(f"arm {evil}")
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 0, 1), limits=(-10, 80), name=f"hinge {evil}")
    assert evil not in kinefab.report(scene, tmp_path / "report.html").read_text("utf-8")


def test_an_empty_page_says_so_and_a_loose_part_counts_alike_everywhere(tmp_path):
    data = described(kinefab.view(kinefab.Scene(), tmp_path / "empty.html").read_text("utf-8"))
    assert data["notices"] == ["This scene is empty."] and "islands" not in dict(data["facts"])
    scene = kinefab.Scene()
    scene.add_part("Block", trimesh.creation.box((0.1, 0.2, 0.3)))
    data = described(kinefab.view(scene, tmp_path / "block.html").read_text("utf-8"))
    assert data["subtitle"] == "1 object · 0 joints · mobility 6" and dict(data["facts"])["mobility"] == "6"


def test_round_numbers_on_the_axes():
    from kinefab.views.page.plots import ticks

    assert ticks(0.0, 360.0) == [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0]
    assert ticks(0.0, 360.0, True) == [0.0, 60.0, 120.0, 180.0, 240.0, 300.0, 360.0]
    assert ticks(-10.0, 80.0, True) == [0.0, 15.0, 30.0, 45.0, 60.0, 75.0]
    assert ticks(-4.0, 8.0, True) == ticks(-4.0, 8.0)
    assert ticks(-1900.0, 1900.0, True) == [-1440.0, -720.0, 0.0, 720.0, 1440.0]
    assert ticks(-0.026, 0.0251) == [-0.02, -0.01, 0.0, 0.01, 0.02]


def test_a_constant_is_a_straight_line_on_the_axes():
    """A rack's transmission was drawn as a wild curve, of the solution's last digits, over an axis of one number."""
    from kinefab.views.page.plots import Curve, plot

    driven = np.linspace(0.0, 360.0, 61)
    last_digits = np.where(np.arange(61) % 2, 1.0, -1.0)
    for value, noise in ((3.49e-4, 1e-12), (-2.0, 1e-10), (0.0, 1e-15)):
        text = plot(driven, [Curve("Rack", value + noise * last_digits)], "Wheel, degrees", "m per degree")
        points = re.search(r'points="([^"]*)"', text).group(1).split()
        assert len({point.split(",")[1] for point in points}) == 1
        numbers = re.findall(r'text-anchor="end">([^<]*)<', text)
        assert len(numbers) == len(set(numbers)) and any(float(n) > value for n in numbers)


def test_a_slide_s_end_out_of_sight_is_none(tmp_path):
    """One limit at -0.04 m, the other 100 m off, as Unity needs one: a slider over 100 m is of no use, and its way took hours."""
    from kinefab.showing import reach_of
    from kinefab.views.extent import ends_in_sight, span_of

    scene = kinefab.Scene()
    base = scene.add_part("Base", trimesh.creation.box((0.3, 0.1, 0.2)), grounded=True)
    arm = scene.add_part("Arm", trimesh.creation.box((0.1, 0.1, 0.5)), translation=(0.1, 0.1, 0))
    scene.add_slider(base, arm, point=(0, 0, 0), axis=(1, 0, 0), limits=(-0.04, 99.96), name="Slide")
    path = tmp_path / "slide.kinefab"
    kinefab.export(scene, path)
    assert span_of(json.loads(path.read_text("utf-8"))) == pytest.approx(0.5)
    (slide,) = described(kinefab.view(path, tmp_path / "page.html").read_text("utf-8"))[
        "coordinates"
    ].values()
    assert (slide["lower"], slide["upper"], slide["size"]) == (
        pytest.approx(-0.04),
        None,
        pytest.approx(0.25),
    )
    low, high, words = reach_of(kinefab.motion(path), "Slide", 0.5)
    assert (low, high) == (pytest.approx(-0.04), pytest.approx(0.5)) and words == ("its limit", "and on")
    assert ends_in_sight(0.0, -10.0, 80.0, 1.0) == (-10.0, np.inf)
    assert ends_in_sight(70.0, -10.0, 80.0, 1.0) == (-np.inf, 80.0)
