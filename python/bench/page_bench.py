"""How fast the page draws: frames a second of 2,000 moving parts with a million triangles, in Chromium.

    python python/bench/page_bench.py [--parts N] [--triangles N] [--frames N] [--gpu]

Every part hangs on a hinge and all of them play at once, so that each frame moves everything; edges are drawn, the window is
1,200 by 760.  Two figures: frames a second, and the milliseconds that the page's own code takes of a frame (with the draw calls themselves left
out), which bound the frames a second where a graphics card does the rest.  Without ``--gpu`` the browser draws in software
(SwiftShader), on the processor's cores, and copies each picture; then the first figure is that of the processor.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import trimesh

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "python")]

import kinefab  # noqa: E402
from browser import Opened, browser, window  # noqa: E402

DEFINITIONS = 25
PLAY = """async ([frames, drawing]) => {
    const stage = kinefab.stage, app = kinefab, moving = [], drawn = [];
    for (const name of app.mechanism.freedoms) app.playing.add(name);
    const gl = stage.renderer.getContext(), pixel = new Uint8Array(4);
    const asked = [gl.drawArrays, gl.drawElements];
    if (!drawing) gl.drawArrays = gl.drawElements = () => {};
    const render = stage.renderer.render;
    stage.renderer.render = function (...given) {
        const begun = performance.now();
        render.apply(this, given);
        drawn.push(performance.now() - begun);
    };
    const start = performance.now();
    for (let i = 0; i < frames; i++) {
        const begun = performance.now();
        app.advance(1 / 30);
        moving.push(performance.now() - begun);
        await new Promise(done => requestAnimationFrame(done));
        if (drawing) gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);  // waits until it is drawn
    }
    const seconds = (performance.now() - start) / 1000;
    stage.renderer.render = render;
    [gl.drawArrays, gl.drawElements] = asked;
    return {seconds, moving, drawn, triangles: stage.triangles, calls: stage.renderer.info.render.calls};
}"""


def pendulums(parts: int, triangles: int) -> kinefab.Scene:
    """A field of parts, each on a hinge of its own; ``DEFINITIONS`` shapes."""
    scene, around = kinefab.Scene(), max(3, triangles // (4 * parts))
    sizes = (0.02 + 0.0004 * i for i in range(DEFINITIONS))
    shapes = [trimesh.creation.cylinder(radius=size, height=0.05, sections=around) for size in sizes]
    columns = int(np.ceil(parts**0.5))
    for i in range(parts):
        x, z = 0.06 * (i % columns), 0.06 * (i // columns)
        number = scene.add_part(f"Part{i}", shapes[i % DEFINITIONS], translation=(x, 0, z))
        scene.add_hinge(None, number, point=(x, 0.04, z), axis=(1, 0, 0), limits=(-10, 80), name=f"Hinge{i}")
    return scene


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--parts", type=int, default=2000)
    parser.add_argument("--triangles", type=int, default=1_000_000)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--gpu", action="store_true", help="let the browser use the graphics card")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, browser(gpu=asked.gpu) as running:
        start = time.perf_counter()
        path = kinefab.view(pendulums(asked.parts, asked.triangles), Path(folder) / "page.html")
        made = time.perf_counter() - start
        start = time.perf_counter()
        opened = Opened(window(running), path)
        loaded = time.perf_counter() - start
        found = opened.page.evaluate(PLAY, [asked.frames, True])
        own = opened.page.evaluate(PLAY, [asked.frames, False])
        opened.demand_quiet()
        megabytes = path.stat().st_size / 1e6
    moving, drawing = (float(np.median(own[key])) for key in ("moving", "drawn"))
    print(f"{asked.parts} parts, {found['triangles']} triangles, {found['calls']} draw calls")
    print(f"page of {megabytes:.1f} MB made in {made:.1f} s, opened in {loaded:.1f} s")
    print(f"{asked.frames / found['seconds']:.1f} frames/s{'' if asked.gpu else ', drawn in software'}")
    print(
        f"the page's own code: {moving:.1f} ms a frame to move the parts, {drawing:.1f} ms to ask for the drawing;"
    )
    print(f"{1000 / (moving + drawing):.0f} frames/s where a graphics card keeps up")


if __name__ == "__main__":
    main()
