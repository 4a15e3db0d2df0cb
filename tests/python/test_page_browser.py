"""The page in a real browser: it is quiet, and its sliders move parts to where ``kinefab.motion`` has them."""

from __future__ import annotations

import math
import os
from io import BytesIO
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from browser import CHROMIUM, Opened, browser, window
from kinefab.unity.back.scene_file import read_scene
from kinefab.views import overview

pytest.importorskip("playwright", reason="no playwright: the page is not tried in a browser")
PIL = pytest.importorskip("PIL.Image", reason="no Pillow: the page's picture is not looked at")
if CHROMIUM is None:
    pytest.skip("no chromium (Debian: apt-get install chromium): the page is not tried in a browser", allow_module_level=True)

ROOT = Path(__file__).parents[2]
LEVER = ROOT / "fixtures" / "lever" / "lever.kinefab"
STEP = ROOT / "fixtures" / "lever" / "lever.step"
PLACES = """names => Object.fromEntries(kinefab.data.parts.filter(p => names.includes(p.id)).map(p => [p.id,
    Frame.times(kinefab.mechanism.displaced[p.body], p.pose)]))"""


@pytest.fixture(scope="module")
def running():
    with browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def context(running):
    return window(running)


def shown(context, tmp_path, source, name="page"):
    path = tmp_path / f"{name}.html"
    kinefab.view(source, path)
    return Opened(context, path)


MECHANISMS = ["M01", "M03", "M13", "M14", "M18", "M21", "M27", "M33", "M36", "M46", "M48"]


@pytest.mark.parametrize("id", [*MECHANISMS, "lever"])
def test_sliders_move_parts_to_where_motion_has_them(context, tmp_path, id):
    """A joint, a baked loop, a loop solved in the page, gears: every freedom set by its slider's own input."""
    path = LEVER if id == "lever" else ROOT / "fixtures" / "mechanisms" / f"{id}.kinefab"
    opened = shown(context, tmp_path, path, id)
    mechanism = kinefab.motion(path)
    size = max(
        np.ptp(mechanism.sweep(mechanism.freedoms[0].name, frames=2, start=0, stop=0).poses[0, :, :3]), 0.1
    )
    bodies = [part for part in mechanism.parts if part != mechanism.parts[0]]
    names = opened.page.evaluate("kinefab.mechanism.freedoms")
    assert len(names) == len(mechanism.freedoms) > 0
    for name in names[:3]:
        unit = mechanism.coordinate(name).unit
        goal = mechanism.coordinate(name).value + (23.0 if unit == "deg" else 0.04)
        motion = mechanism.sweep(name, goal - (23.0 if unit == "deg" else 0.04), goal, frames=5)
        assert motion.stop is None
        index = names.index(name)
        opened.page.locator(".freedom input[type=range]").nth(index).evaluate(
            "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }", goal
        )
        places = opened.page.evaluate(PLACES, bodies)
        for body in bodies:
            found = np.array(places[body]).reshape(3, 4)
            assert np.abs(found[:, 3] - motion.part(body)[-1, :3]).max() < 1e-5 * size
        opened.page.evaluate("kinefab.reset()")
    opened.demand_quiet()
    opened.page.close()


def slider_of(degrees):
    q = math.radians(degrees)
    return 0.025 * math.cos(q) + math.sqrt(0.09**2 - (0.025 * math.sin(q)) ** 2)


def test_dragging_a_part_moves_the_mechanism(context, tmp_path):
    """The grip of the lever is pulled by the mouse: the crank follows it, and the slider the crank."""
    opened = shown(context, tmp_path, LEVER)
    page = opened.page
    place = """() => { const i = kinefab.data.parts.findIndex(p => p.name === 'Grip'), part = kinefab.data.parts[i];
        const box = kinefab.stage.parts[i].mesh.geometry.boundingBox.getCenter(new THREE.Vector3());
        const at = Frame.point(Frame.times(kinefab.mechanism.displaced[part.body], part.pose), box.toArray());
        const seen = kinefab.stage.screen(at), canvas = document.getElementById('view').getBoundingClientRect();
        return [seen.x + canvas.x, seen.y + canvas.y]; }"""
    page.wait_for_timeout(100)
    x, y = page.evaluate(place)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 40, steps=4)
    page.mouse.move(x + 120, y + 90, steps=4)
    page.mouse.up()
    angle = float(page.locator(".freedom input[type=number]").input_value())
    assert abs(angle) > 5.0
    places = page.evaluate(PLACES, ["Lever/SliderD:1"])
    exact = page.evaluate("kinefab.mechanism.shown(kinefab.mechanism.freedoms[0])")
    assert places["Lever/SliderD:1"][3] == pytest.approx(slider_of(30.0 + exact), abs=1e-7)
    moved = np.subtract(page.evaluate(place), [x, y])
    assert moved @ [120, 90] > 0.3 * 150 * 150  # the grip came along with the mouse
    opened.demand_quiet()
    page.close()


def test_playing_comes_round_and_a_click_tells_what_a_joint_is(context, tmp_path):
    opened = shown(context, tmp_path, LEVER)
    page = opened.page
    page.locator("#view").focus()
    page.keyboard.press("Space")
    turned = "Math.abs(kinefab.mechanism.q[kinefab.mechanism.freedoms[0]])"
    for _ in range(100):
        if page.evaluate(turned) > 0.05:
            break
        page.wait_for_timeout(50)
    assert page.evaluate(turned) > 0.05
    page.keyboard.press("Space")
    page.locator("nav button", has_text="Joints").click()
    page.locator("#list .row").first.click()
    told = page.locator("#detail").inner_text()
    assert "Insert:1" in told and "HingeJoint" in told and "insert of" in told
    page.locator("nav button", has_text="Report").click()
    page.locator("#list .entry", has_text="Insert:5").click()
    assert page.locator("#detail h3").inner_text().startswith("SliderD:1")
    opened.demand_quiet()
    page.close()


EVIL = "</script><script>window.pwned=1</script><img src=x onerror='window.pwned=1'>%CODE%\u2028`${window.pwned=1}"


def test_names_stay_text(context, tmp_path):
    """A part, a joint and a source named as code are shown as they are named, and nothing runs."""
    scene = kinefab.Scene()
    base = scene.add_part(EVIL, grounded=True)
    arm = scene.add_part(f"arm {EVIL}", translation=(0, 0.1, 0))
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 0, 1), name=EVIL, limits=(-10, 80))
    opened = shown(context, tmp_path, scene)
    opened.page.locator("nav button", has_text="Joints").click()
    opened.page.locator("#list .row").first.click()
    assert opened.page.evaluate("window.pwned === undefined")
    opened.page.locator("nav button", has_text="Parts").click()
    assert "<img src=x" in opened.page.locator("#list").inner_text()
    low, high = (
        float(opened.page.locator(".freedom input[type=range]").get_attribute(end)) for end in ("min", "max")
    )
    assert (low, high) == (pytest.approx(-10.0), pytest.approx(80.0))
    opened.demand_quiet()
    opened.page.close()


def test_parts_can_be_hidden_ghosted_and_isolated(context, tmp_path):
    opened = shown(context, tmp_path, LEVER)
    page = opened.page
    states = "kinefab.state.map(s => [s.shown, s.ghost])"
    before = page.evaluate(states)
    page.locator("#list .row", has_text="PanelB:1").click()
    page.keyboard.press("h")
    hidden = page.evaluate(states)
    assert [a[0] != b[0] for a, b in zip(before, hidden)].count(True) == 3  # PanelB and its two bodies
    page.keyboard.press("h")
    page.keyboard.press("g")
    assert sum(ghost for _, ghost in page.evaluate(states)) == 3
    page.keyboard.press("i")
    assert sum(shown for shown, _ in page.evaluate(states)) == 3
    page.keyboard.press("Escape")
    assert page.evaluate(states) == before
    opened.demand_quiet()
    page.close()


PICTURES = Path(__file__).parent / "pictures"
"""What was looked at: the canvas a quarter of its size.  ``KINEFAB_PICTURES=1`` writes them anew; look at them then."""
VIEWS = {"light": (1200, 760, False), "dark": (1200, 760, True), "narrow": (390, 780, False)}


def canvas(page) -> np.ndarray:
    """The canvas as it is drawn, a quarter of its size, (height, width, 3), 0..255."""
    page.wait_for_timeout(300)
    shot = PIL.open(BytesIO(page.screenshot(clip=page.locator("#view").bounding_box()))).convert("RGB")
    return np.asarray(shot.reduce(4), dtype=float)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    """Pixels that clearly differ, as a share of those that are drawn on; a line may lie half a pixel elsewhere."""
    if one.shape != other.shape:
        return 1.0
    differ, drawn = (np.abs(one - base).max(axis=2) for base in (other, one[2, -2]))
    return float((differ > 40.0).sum() / (drawn > 25.0).sum())


@pytest.mark.parametrize("view", VIEWS)
def test_the_picture_is_the_one_that_was_looked_at(running, tmp_path, view):
    """Light, dark and narrow; nothing overflows; the same picture of a crank 20 degrees on is another one."""
    width, height, dark = VIEWS[view]
    opened = shown(window(running, width, height, dark), tmp_path, LEVER)
    picture = canvas(opened.page)
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    path = PICTURES / f"lever-{view}.png"
    if os.environ.get("KINEFAB_PICTURES"):
        PIL.fromarray(picture.astype(np.uint8)).save(path, optimize=True)
    kept = np.asarray(PIL.open(path).convert("RGB"), dtype=float)
    assert apart(picture, kept) < 0.03
    opened.page.locator(".freedom input[type=range]").first.evaluate(
        "slider => { slider.value = Number(slider.value) + 20; slider.dispatchEvent(new Event('input')); }"
    )
    assert apart(canvas(opened.page), kept) > 0.06
    opened.demand_quiet()
    opened.page.close()


def test_a_scene_file_s_page_has_the_scene_s_joints(context, tmp_path):
    opened = shown(context, tmp_path, LEVER)
    joints = [
        c["type"]
        for o in read_scene(LEVER)[0]["gameObjects"]
        for c in o.get("components", ())
        if "Joint" in c["type"]
    ]
    assert opened.page.evaluate("kinefab.data.joints.map(j => j.type)") == joints
    opened.page.close()


def test_found_mates_are_switched_and_copied(context, tmp_path):
    """Each by its number and parts; the choice comes back as the file that was given, with one switched on."""
    import json

    sides = {"a": {"component": "Lever/BarC:1"}, "b": {"component": "Lever/SliderD:1"}}
    mates = {"format": "kinefab.mates", "version": "1.0", "constraints": []}
    for number, enabled in ((1, True), (2, False)):
        mate = {
            "number": number,
            "enabled": enabled,
            "id": f"Mate:{number}",
            "kind": "insert",
            "confidence": 0.5,
        }
        mates["constraints"].append(mate | sides)
    path = tmp_path / "lever.mates.json"
    path.write_text(json.dumps(mates), "utf-8")
    kinefab.view(LEVER, tmp_path / "page.html", kinefab.ExportOptions(reading={"mates": path}))
    opened = Opened(context, tmp_path / "page.html")
    opened.page.locator("nav button", has_text="Mates").click()
    rows = opened.page.locator("#list .row")
    assert rows.count() == 2 and "insert: BarC:1 – SliderD:1" in rows.nth(1).inner_text()
    rows.nth(1).locator("input").check()
    rows.nth(0).click()
    assert opened.page.locator("#detail h3").inner_text() == "Mate 1"
    copied = json.loads(opened.page.evaluate("kinefab.copyMates()"))
    assert [m["enabled"] for m in copied["constraints"]] == [True, True]
    copied["constraints"][1]["enabled"] = False
    assert copied == mates
    opened.demand_quiet()
    opened.page.close()


def test_found_mates_stand_as_numbers_where_they_are(context, tmp_path):
    """A STEP file, its mates found: the page moves by them, and a click on a number chooses that mate."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed")
    options = kinefab.ExportOptions(colliders="none", reading={"mates": "auto"})
    kinefab.view(STEP, tmp_path / "page.html", options)
    opened = Opened(context, tmp_path / "page.html")
    assert opened.page.locator("#freedoms .freedom").count() == 1
    seen = "kinefab.numbers.items.filter(i => i.sprite.visible).map(i => i.mate.number)"
    assert opened.page.evaluate(seen) == []
    opened.page.locator("nav button", has_text="Mates").click()
    numbers = opened.page.evaluate(seen)
    assert (
        numbers == [mate["number"] for mate in opened.page.evaluate("kinefab.data.mates.constraints")]
        and len(numbers) > 3
    )
    last = numbers[-1]
    place = opened.page.evaluate(
        f"kinefab.stage.screen(kinefab.numbers.items.find(i => i.mate.number === {last}).mate.a.p)"
    )
    opened.page.locator("#view").click(position={"x": place["x"], "y": place["y"]})
    assert opened.page.locator("#detail h3").inner_text() == f"Mate {last}"
    assert opened.page.evaluate(
        "kinefab.numbers.items.filter(i => i.drawn === 'chosen').map(i => i.mate.number)"
    ) == [last]
    opened.page.locator("#list .row").nth(last - 1).locator("input").uncheck()
    opened.page.locator("nav button", has_text="Parts").click()
    assert opened.page.evaluate(seen) == []
    opened.demand_quiet()
    opened.page.close()


def test_a_capsule_collider_is_round_at_both_ends(context, tmp_path):
    """Radius 0.1, height 0.5 along X: as long and as thick (to its 16 sides), and no end is flat."""
    scene = kinefab.Scene()
    pose = kinefab.Pose(np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]), np.array([0.0, 0, 0]))
    shape = kinefab.Collider(kinefab.ColliderKind.CAPSULE, pose, radius=0.1, length=0.3)
    scene.add_part("Rod", grounded=True, collider=shape)
    opened = shown(context, tmp_path, scene)
    opened.page.get_by_role("button", name="Colliders").click()
    drawn = opened.page.evaluate(
        "(() => { const m = kinefab.glyphs.colliders[0]; return Array.from(m.geometry.attributes.position.array); })()"
    )
    corners = np.reshape(drawn, (-1, 3))
    assert np.ptp(corners, axis=0) == pytest.approx([0.2, 0.5, 0.2], abs=3e-3)
    ends = corners[np.abs(corners[:, 1]) > 0.25 - 1e-6]
    assert np.abs(ends[:, [0, 2]]).max() < 1e-6
    opened.demand_quiet()
    opened.page.close()


def test_the_lists_and_the_view_go_by_keys(context, tmp_path):
    """A list is one stop of Tab: arrows choose and fold; letters work wherever nothing is typed."""
    opened = shown(context, tmp_path, LEVER)
    page = opened.page
    chosen = "kinefab.data.parts[kinefab.chosen.part].name"
    page.locator("#search").focus()
    page.keyboard.press("Tab")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    assert page.evaluate(chosen) == page.locator("#list .row .name").nth(1).inner_text()
    page.keyboard.press("ArrowUp")
    rows = page.locator("#list .row").count()
    page.keyboard.press("ArrowLeft")
    assert page.locator("#list .row").count() == 1
    page.keyboard.press("ArrowRight")
    assert page.locator("#list .row").count() == rows
    for _ in range(rows + 3):
        page.keyboard.press("ArrowDown")
    assert page.evaluate(chosen) == page.locator("#list .row .name").last.inner_text()
    assert page.locator("#list [aria-selected=true]").get_attribute("id") == "chosen"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "view"
    for tab, kind in (("Joints", "joint"), ("Report", "entry")):
        page.locator("nav button", has_text=tab).click()
        page.locator("#list").focus()
        page.keyboard.press("ArrowDown")
        assert page.evaluate(f"kinefab.chosen.{kind} !== undefined")
    page.locator("#glyphs").focus()
    page.keyboard.press("c")
    assert page.locator("#colliders").get_attribute("aria-pressed") == "true"
    page.keyboard.press(" ")
    assert page.locator("#glyphs").get_attribute("aria-pressed") == "false"
    assert not page.evaluate("Boolean(kinefab.running)")
    page.locator("nav button", has_text="Parts").click()
    page.locator("#search").fill("c")
    page.keyboard.press("c")
    assert page.locator("#colliders").get_attribute("aria-pressed") == "true"
    opened.demand_quiet()
    page.close()


def test_a_narrow_page_s_closed_panels_are_no_stops_of_tab(running, tmp_path):
    opened = shown(window(running, 390, 780), tmp_path, LEVER)
    page = opened.page
    stops = set()
    for _ in range(30):
        page.keyboard.press("Tab")
        stops.add(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
    assert "view" in stops and not stops & {"search", "list"}
    page.locator("#menu").click()
    page.wait_for_timeout(400)
    page.locator("#search").focus()
    assert page.evaluate("document.activeElement.id") == "search"
    opened.demand_quiet()
    page.close()


def test_a_printed_page_has_the_mechanism_on_white(running, tmp_path):
    """The part of the page that is drawn was left out on paper: of a page without a report nothing came out at all."""
    opened = shown(window(running, dark=True), tmp_path, LEVER)
    opened.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert opened.page.evaluate("document.documentElement.dataset.theme") == "light"
    opened.page.emulate_media(media="print")
    image = PIL.open(BytesIO(opened.page.locator("#printed").screenshot())).convert("RGB")
    pixels = np.asarray(image, dtype=int)
    assert (pixels[:4] == 255).all() and (np.ptp(pixels.reshape(-1, 3), axis=0) > 150).all()
    opened.page.emulate_media(media="screen")
    opened.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert opened.page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert not opened.page.locator("#printed").is_visible()
    opened.demand_quiet()
    opened.page.close()


def test_a_flat_side_of_a_drawing_has_no_seams(running, tmp_path):
    """A side is many triangles; where a browser blends both at their common edge the white behind shone through."""
    scene = kinefab.Scene()
    scene.add_part("Block", trimesh.creation.box((0.4, 0.1, 0.3)), grounded=True)
    written = kinefab.export(scene, tmp_path / "block.kinefab").path
    page = running.new_page(viewport={"width": 330, "height": 160})
    page.set_content(f"<body style='margin: 0'>{overview.picture(written)}</body>")
    pixels = np.asarray(PIL.open(BytesIO(page.screenshot())).convert("RGB"), dtype=int)[:, :200]
    colours, count = np.unique(pixels.reshape(-1, 3), axis=0, return_counts=True)
    widest = colours[np.argsort(count)[-2]]  # after the white around
    side = (pixels == widest).all(axis=2)
    assert side.sum() > 3000
    for row in side[side.sum(axis=1) > 20]:
        first, *_, last = np.flatnonzero(row)
        assert row[first:last].all()
    page.close()
