"""The commands ``kinefab capture``: the programs that are captured, each with what its user has to do."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import typer

from ..diagnostics import KinefabError, Report
from .console import count, demand_axis, demand_ending, fail, remark, tell, typed, unwritable_as_finding
from .declared import AS_JSON, BUNDLE

if TYPE_CHECKING:
    from ..capture.run import Captured

NOT_YET = "Not yet run inside the program: written to its documentation, and the capture checks itself."
OUTPUT: Path = typer.Option(
    ..., "--output", "-o", help="Bundle to write: NAME.bundle.json.", show_default=False
)
RECORD: Optional[Path] = typer.Option(
    None, "--record", help="Write the program's raw answers to this file too."
)
BLANK: bool = typer.Option(False, "--blank-names", help="With --record: replace every name by a number.")
UP: Optional[str] = typer.Option(None, "--up", help="Axis that is up in the assembly: X, Y or Z.")

HELP_COM = f"""Capture the assembly that is open in {{name}} (Windows).

\b
1. On the computer that runs {{name}}, with 64-bit Python, in a clone: pip install "./python[com]"
2. Open the assembly in {{name}}, save it and end every command and dialog.
3. kinefab capture {{word}} -o robot.bundle.json
4. Read what it says: what did not close at the captured pose is named.
5. kinefab export robot.bundle.json -o robot.kinefab

{NOT_YET}"""

HELP_ONSHAPE = f"""Capture an assembly of Onshape over its REST API.

\b
1. Make API keys at https://dev-portal.onshape.com/keys, with the right to read documents.
2. Set ONSHAPE_ACCESS_KEY and ONSHAPE_SECRET_KEY in the environment; they are never written anywhere.
3. kinefab capture onshape "https://cad.onshape.com/documents/.../w/.../e/..." -o robot.bundle.json
4. Read what it says: what did not close at the captured pose is named.
5. kinefab export robot.bundle.json -o robot.kinefab

\b
Or from saved answers: a folder with definition.json and, where you have them, features.json, matevalues.json.

{NOT_YET}"""

HELP_FUSION = f"""Write the add-in that captures the design open in Fusion.

\b
1. kinefab capture fusion --install "%APPDATA%/Autodesk/Autodesk Fusion 360/API/AddIns"
2. In Fusion: Utilities, Add-Ins, Scripts and Add-Ins, KinefabCapture, Run; with a design open and saved.
3. Choose where robot.bundle.json is to be; robot.record.json is written beside it.
4. kinefab capture --replay robot.record.json -o robot.bundle.json    checks it: Fusion's own Python cannot.
5. kinefab export robot.bundle.json -o robot.kinefab

{NOT_YET}"""


def capture_commands() -> typer.Typer:
    """The group of commands."""
    group = typer.Typer(
        name="capture",
        short_help="Write what a running CAD program says of its open assembly as a CAD bundle.",
        help=f"Write what a CAD program says of its open assembly as a CAD bundle. {NOT_YET}",
        invoke_without_command=True,
        no_args_is_help=True,
    )

    @group.callback()
    def from_record(
        context: typer.Context,
        replay: Optional[Path] = typer.Option(
            None, "--replay", help="Read the answers from a record, without the program."
        ),
        output: Optional[Path] = typer.Option(
            None, "--output", "-o", help="With --replay: NAME.bundle.json."
        ),
        up: Optional[str] = UP,
        as_json: bool = AS_JSON,
    ) -> None:
        if context.invoked_subcommand is not None:
            if replay is not None or output is not None or up is not None or as_json:
                raise typer.BadParameter(
                    "--replay stands without a program, and a program's options stand behind its name"
                )
            return
        if replay is None or output is None:
            raise typer.BadParameter("--replay needs a record, and --output the bundle to write")
        from ..capture.run import replay as run

        _finish(lambda report: run(replay, output, report, _axis(up)), output, as_json)

    def over_com(word: str, name: str) -> None:
        @group.command(name=word, help=HELP_COM.format(name=name, word=word))
        def program(
            output: Path = OUTPUT,
            record: Optional[Path] = RECORD,
            blank_names: bool = BLANK,
            up: Optional[str] = UP,
            as_json: bool = AS_JSON,
        ) -> None:
            from ..capture.run import capture as run

            _finish(lambda report: run(word, output, report, record, blank_names, _axis(up)), output, as_json)

        _ = program

    over_com("inventor", "Inventor")
    over_com("solidworks", "SolidWorks")

    @group.command(help=HELP_ONSHAPE)
    def onshape(
        source: str = typer.Argument(
            ..., help="Address of the assembly's tab, or a folder of saved answers."
        ),
        output: Path = OUTPUT,
        record: Optional[Path] = RECORD,
        blank_names: bool = BLANK,
        up: Optional[str] = UP,
        as_json: bool = AS_JSON,
    ) -> None:
        from ..capture.run import capture_onshape as run

        _finish(
            lambda report: run(source, os.environ, output, report, record, blank_names, _axis(up)),
            output,
            as_json,
        )

    @group.command(help=HELP_FUSION)
    def fusion(
        install: Path = typer.Option(
            ..., "--install", help="Folder for add-ins, which is there, to write ours into.", show_default=False
        ),
        output: Optional[Path] = typer.Option(None, "--output", "-o", hidden=True, callback=_no_output),
        as_json: bool = AS_JSON,
    ) -> None:
        from ..capture.fusion.install import NAME, install as run

        with unwritable_as_finding(install / NAME, as_json):
            made = run(install)
        remark(f"{made}: the add-in was written.")
        tell(Report(), made, as_json, True)

    _ = onshape, fusion
    _ = from_record
    return group


def _no_output(output: Path | None) -> None:
    """What works with every other program is asked of Fusion too."""
    if output is not None:
        raise typer.BadParameter(
            "Fusion is captured inside it: write the add-in with --install FOLDER, run it there, "
            f"then: kinefab capture --replay RECORD -o {typed(output)}"
        )


def _axis(up: str | None) -> str:
    """ "" where it is not stated."""
    return "" if up is None else demand_axis(up)


def _finish(run: Callable[[Report], Captured], output: Path, as_json: bool) -> None:
    demand_ending(output, BUNDLE)
    report = Report()
    try:
        done = run(report)
    except KinefabError:
        typer.echo(f"{output} was not written.", err=True)
        fail(report, output, as_json, False)
    except OSError as error:
        report.add("TARGET_UNWRITABLE", path=error.filename or output, detail=error.strerror or str(error))
        fail(report, output, as_json, False)
    tell(report, output, as_json, True)
    draft = done.draft
    counts = ", ".join(
        count(len(records), word, f"{word}s")
        for word, records in (
            ("component", draft.components), ("joint", draft.joints), ("constraint", draft.constraints),
            ("coupling", draft.couplings),
        )
    )  # fmt: skip
    remark(f"{output}: {counts}; {count(done.calls, 'answer', 'answers')} of {draft.program}.")
