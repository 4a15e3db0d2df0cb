"""Debian's Chromium, driven by Playwright, with software rendering: for the tests of the page."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = (
    "--no-sandbox --disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync"
).split()
SOFTWARE = "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader".split()


@contextmanager
def browser(gpu: bool = False) -> Iterator:
    """A running browser with a profile of its own.  gpu: whether it may use a graphics card."""
    from playwright.sync_api import sync_playwright

    flags = FLAGS if gpu else FLAGS + SOFTWARE
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=CHROMIUM, headless=True, args=flags)
        yield running
        running.close()


def window(running, width: int = 1200, height: int = 760, dark: bool = False):
    """A context of its own in a running browser."""
    scheme = "dark" if dark else "light"
    return running.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)


class Opened:
    """A page that is ready, and everything that it said and asked for."""

    def __init__(self, context, path: Path):
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.page = context.new_page()
        self.page.on("console", lambda m: self.errors.append(m.text) if m.type == "error" else None)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(path.as_uri())
        self.page.wait_for_selector("body[data-ready]", timeout=60_000)

    def demand_quiet(self) -> None:
        """No error was said, and nothing was asked for but the page itself (and data in it)."""
        assert self.errors == []
        asked = [url for url in self.requests if not url.startswith(("data:", "blob:"))]
        assert len(asked) == 1 and asked[0].startswith("file:")
