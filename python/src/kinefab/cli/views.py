"""What people look at: ``kinefab draw``, ``view`` and ``report``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any, Optional

import typer

from ..diagnostics import KinefabError, Report
from ..options import ExportOptions, Ground
from ..sources import source_options
from .asking import asking
from .console import demand_ending, fail, progress_bar, remark, tell, write
from .declared import AS_JSON

SOURCE: Path = typer.Argument(..., help="Scene or assembly: NAME.kinefab or any source.", show_default=False)
BROWSER_SECONDS = 3.0
"""After which what was started is a browser, which stays."""


@asking(("reading", source_options()))
def draw(
    reading: dict[str, Any],
    file: Path = SOURCE,
    output: Path = typer.Option(
        ..., "--output", "-o", help="Picture to write: NAME.svg, .png, .gif or .webp.", show_default=False
    ),
    motion: bool = typer.Option(False, "--motion", help="A moving SVG; .gif and .webp always move."),
    joint: Optional[str] = typer.Option(
        None, "--joint", help="What is driven; without it the first freedom."
    ),
    as_json: bool = AS_JSON,
) -> None:
    """Draw a scene: its bodies, its joints and how far they move."""
    demand_ending(output, ".svg", ".png", ".gif", ".webp")
    ending, options, found = output.suffix.lower(), _options(file, reading), Report()
    _demand_motion(ending, motion, joint)
    try:
        if ending == ".svg" and not motion and file.suffix.lower() == ".kinefab":
            from ..views.overview import picture

            content = picture(file).encode("utf-8")
        elif ending == ".svg" and not motion:
            from ..filming import still

            content = still(file, options, found)
        else:
            from ..filming import film

            with progress_bar() as progress:
                content = film(file, ending, joint, options, found, progress)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--joint") from None
    except KinefabError as error:
        fail(error, output, as_json, False)
    write(output, content, as_json)
    _tell(found, output, as_json)


@asking(("reading", source_options()))
def view(
    reading: dict[str, Any],
    source: Path = SOURCE,
    output: Optional[Path] = typer.Option(
        None,
        "--output",
        "-o",
        help="Page to write: NAME.html; without it, in this folder.",
        show_default=False,
    ),
    open_: bool = typer.Option(False, "--open", help="Open it in the browser."),
    as_json: bool = AS_JSON,
) -> None:
    """Write one HTML page that plays the mechanism. Every freedom is on a slider; nothing is fetched."""
    page = Path(source.name.split(".")[0] + ".html") if output is None else output
    demand_ending(page, ".html")
    from ..showing import view as run

    found = Report()
    try:
        run(source, page, _options(source, reading, "mates"), found)
    except KinefabError as error:
        fail(error, page, as_json, False)
    _tell(found, page, as_json)
    if open_ and not _opened(page):
        remark(f"No browser could be started; open {page} in one.")


@asking(("reading", source_options()))
def report(
    reading: dict[str, Any],
    source: Path = SOURCE,
    output: Path = typer.Option(..., "--output", "-o", help="Page to write: NAME.html.", show_default=False),
    as_json: bool = AS_JSON,
) -> None:
    """Write the page of view with a report below it. The analysis in words, a plot of each freedom, what was lost."""
    demand_ending(output, ".html")
    from ..showing import report as run

    found = Report()
    try:
        run(source, output, _options(source, reading, "mates"), found)
    except KinefabError as error:
        fail(error, output, as_json, False)
    _tell(found, output, as_json)


def _demand_motion(ending: str, motion: bool, joint: str | None) -> None:
    """What is said of a motion would go unheard in a picture that stands still."""
    if ending == ".png" and motion:
        raise typer.BadParameter("a .png stands still; write .svg, .gif or .webp", param_hint="--motion")
    if joint is not None and not motion and ending in (".png", ".svg"):
        told = "nothing is driven in a picture that stands still; write .svg with --motion, .gif or .webp"
        raise typer.BadParameter(told, param_hint="--joint")


def _opened(page: Path) -> bool:
    """Show a page in the browser; False where none could be started.  What that says on its way is not for this terminal."""
    if not sys.platform.startswith(("linux", "freebsd")):
        return typer.launch(str(page)) == 0
    silent: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    try:
        started = subprocess.Popen(["xdg-open", page.resolve()], start_new_session=True, **silent)
        return started.wait(BROWSER_SECONDS) == 0
    except subprocess.TimeoutExpired:
        return True
    except OSError:
        return False


def _tell(found: Report, written: Path, as_json: bool) -> None:
    """What was found on the way, and where the file is."""
    if not as_json:
        typer.echo(written)
    tell(found, written, as_json, True)


def _options(source: Path, reading: dict[str, Any], *of_scenes: str) -> ExportOptions:
    """What a source is exported with to be looked at.  of_scenes: reading options that mean something for a written scene too."""
    if source.suffix.lower() == ".kinefab":
        for name in reading.keys() - set(of_scenes):
            hint = f"--{name.replace('_', '-')}"
            raise typer.BadParameter(f"{source} is exported already; it is for its source", param_hint=hint)
        if reading.get("mates") == "auto":
            raise typer.BadParameter(
                "a scene names a NAME.mates.json; auto is for its source", param_hint="--mates"
            )
    return ExportOptions(reading=reading, ground=Ground.among(reading))
