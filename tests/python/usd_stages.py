"""Small USD stages for tests, written as text."""

from __future__ import annotations

from pathlib import Path

from kinefab.diagnostics import KinefabError, Report
from kinefab.model import Scene
from kinefab.sources import read

BODY = '(prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])'
MASS = "float physics:mass = 2; point3f physics:centerOfMass = (0, 0, 0); float3 physics:diagonalInertia = (1, 1, 1)"


def stage(content: str, up: str = "Z", metres: float = 1.0, more: str = "") -> str:
    """A stage with the prims in ``content``.  more: further metadata."""
    return f'#usda 1.0\n(\n upAxis = "{up}"\n metersPerUnit = {metres:g}\n {more}\n)\n{content}\n'


def body(name: str, at=(0, 0, 0), inside: str = "", mass: str = MASS) -> str:
    """A rigid body without shape.  inside: attributes and children."""
    place = f"double3 xformOp:translate = ({at[0]}, {at[1]}, {at[2]})"
    return (
        f'def Xform "{name}" {BODY} {{\n {mass}\n {place}\n'
        f' uniform token[] xformOpOrder = ["xformOp:translate"]\n {inside}\n}}\n'
    )


def joint(
    kind: str, name: str = "J", inside: str = "", body0: str = "", body1: str = "/B", schemas: str = ""
) -> str:
    """A joint; an empty body is the world.  schemas: applied ones, quoted."""
    bodies = "".join(f" rel physics:body{i} = <{b}>\n" for i, b in enumerate((body0, body1)) if b)
    applied = f"(prepend apiSchemas = [{schemas}])" if schemas else ""
    return f'def {kind} "{name}" {applied} {{\n{bodies}{inside}\n}}\n'


def scene_of(folder: Path, text: str, name: str = "stage.usda", **options) -> tuple[Scene | None, Report]:
    """The scene that a text is read as, None where it is refused, and the report."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    report = Report()
    try:
        return read(path, report, options=options), report
    except KinefabError:
        return None, report


def codes(report: Report) -> set[str]:
    return {found.code for found in report.diagnostics}
