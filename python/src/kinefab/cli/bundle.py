"""The commands ``kinefab bundle``; what takes long to import is imported inside."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import typer

from ..diagnostics import KinefabError, Report, Severity
from .console import count, demand_axis, demand_ending, fail, remark, tell, typed, write
from .declared import AS_JSON, BUNDLE

if TYPE_CHECKING:
    from ..pipeline import Analysed

UNITS = "mm cm dm m um in ft yd millimeter centimeter micron inch foot".split()


def _moving(found: Analysed) -> str:
    """What a bundle without errors still may want: a part that stands still, joints."""
    from ..model import NodeKind

    parts = [node for node in found.scene.nodes if node.kind is NodeKind.PART]
    grounded = sum(node.grounded for node in parts) or "none"
    joints = count(len(found.scene.joints), "joint", "joints")
    return f"{count(len(parts), 'part', 'parts')}, {grounded} of them grounded; {joints}; mobility {found.analysis.mobility}."


def bundle_commands() -> typer.Typer:
    """The group of commands."""
    group = typer.Typer(name="bundle", help="Begin a CAD bundle by hand, and check it.", no_args_is_help=True)

    @group.command()
    def init(
        folder: Path = typer.Argument(..., help="Folder of meshes, one part a file.", show_default=False),
        output: Optional[Path] = typer.Option(
            None, "--output", "-o", help="NAME.bundle.json; in the folder, by its name, otherwise."
        ),
        units: Optional[str] = typer.Option(
            None,
            "--units",
            help=f"Unit of the mesh files, asked where not stated (glTF is in metres): {', '.join(UNITS)}.",
        ),
        up: Optional[str] = typer.Option(
            None,
            "--up",
            help="Axis that is up in the meshes: X, Y or Z; by default Y in glTF, Z in all others.",
            show_default=False,
        ),
        force: bool = typer.Option(False, "--force", help="Overwrite a bundle that is there."),
        as_json: bool = AS_JSON,
    ) -> None:
        """Begin a bundle of a folder of meshes. It is valid and commented, to go on with by hand."""
        from ..bundling.beginning import are_gltf, begin, meshes_in, tell_folders

        target = folder / f"{folder.resolve().name or 'parts'}{BUNDLE}" if output is None else output
        demand_ending(target, BUNDLE)
        axis = None if up is None else demand_axis(up)
        report = Report()
        try:
            files = meshes_in(folder)
            gltf = are_gltf(files)
            if units is None and gltf:
                units = "m"
            if axis is None and gltf is None:
                told = "glTF is Y up and the other files do not tell; state it: X, Y or Z"
                raise typer.BadParameter(told, param_hint="--up")
            axis = axis or ("Y" if gltf else "Z")
            if units is None and sys.stdin.isatty():
                units = str(typer.prompt("Unit of the mesh files (mm, cm, m, in, ...)"))
            if units not in UNITS:
                told = (
                    "mesh files do not tell their unit; state it"
                    if units is None
                    else f"{units!r} is no unit"
                )
                raise typer.BadParameter(f"{told}: {', '.join(UNITS)}", param_hint="--units")
            if os.path.lexists(target) and not force:
                raise typer.BadParameter(
                    f"{target} is there already; --force overwrites it", param_hint="--output"
                )
            tell_folders(folder, report)
            text = begin(files, target, units, axis)
        except KinefabError as error:
            typer.echo(f"{target} was not written.", err=True)
            fail(error, target, as_json, False)
        write(target, text.encode("utf-8"), as_json)
        remark(
            f"{target}: {count(len(files), 'part', 'parts')} in {units}, {axis} up, no joints yet. "
            f"Ground a part, add joints, then: kinefab bundle check {typed(target)}"
        )
        tell(report, target, as_json, True)

    @group.command()
    def check(
        file: Path = typer.Argument(..., help="NAME.bundle.json.", show_default=False),
        as_json: bool = AS_JSON,
    ) -> None:
        """Tell everything that is missing or wrong in a bundle, at once."""
        if not file.name.lower().endswith(".json"):
            raise typer.BadParameter(f"{file} does not end in {BUNDLE}", param_hint="FILE")
        from ..bundling.checking import check as run

        found, analysed = run(file)
        tell(found, file, as_json)
        errors, warnings = (len(found.of(grade)) for grade in (Severity.ERROR, Severity.WARNING))
        if not as_json:
            told = (count(errors, "error", "errors"), count(warnings, "warning", "warnings"))
            typer.echo(f"{file}: {', '.join(told)}.")
            if analysed is not None:
                typer.echo(_moving(analysed))
        if errors:
            raise typer.Exit(1)

    _ = init, check
    return group
