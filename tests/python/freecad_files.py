"""FreeCAD documents and OndselSolver assemblies written by hand: what FreeCAD would save, without its geometry.

``python tests/python/freecad_files.py`` writes the conformance cases of both formats anew.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

FOLDER = Path(__file__).parents[1] / "conformance" / "invalid" / "source"
JOINT_TYPES = (
    "Fixed Revolute Cylindrical Slider Ball Distance Parallel Perpendicular Angle RackPinion Screw Gears Belt"
).split()

Properties = Mapping[str, tuple[str, str]]


def archive(members: Mapping[str, bytes | str]) -> bytes:
    """A zip, the same bytes for the same members."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), content, zipfile.ZIP_DEFLATED)
    return out.getvalue()


def text(value: str) -> tuple[str, str]:
    return "App::PropertyString", f"<String value={quoteattr(value)}/>"


def number(value: object, kind: str = "App::PropertyFloat") -> tuple[str, str]:
    return kind, f'<Float value="{value}"/>'


def integer(value: int) -> tuple[str, str]:
    return "App::PropertyInteger", f'<Integer value="{value}"/>'


def flag(value: bool) -> tuple[str, str]:
    return "App::PropertyBool", f'<Bool value="{str(value).lower()}"/>'


def word(value: str, words: list[str] = JOINT_TYPES) -> tuple[str, str]:
    """An enumeration with its list."""
    listed = "".join(f"<Enum value={quoteattr(one)}/>" for one in words)
    index = words.index(value) if value in words else len(words)
    if value not in words:
        listed += f"<Enum value={quoteattr(value)}/>"
    return (
        "App::PropertyEnumeration",
        f'<Integer value="{index}" CustomEnum="true"/><CustomEnumList count="{len(words)}">{listed}</CustomEnumList>',
    )


def placement(x=0.0, y=0.0, z=0.0, q=(0.0, 0.0, 0.0, 1.0)) -> tuple[str, str]:
    turn = " ".join(f'Q{i}="{value}"' for i, value in enumerate(q))
    return "App::PropertyPlacement", f'<PropertyPlacement Px="{x}" Py="{y}" Pz="{z}" {turn}/>'


def link(name: str, file: str = "") -> tuple[str, str]:
    return "App::PropertyXLink", f'<XLink file={quoteattr(file)} stamp="" name={quoteattr(name)}/>'


def links(*names: str) -> tuple[str, str]:
    listed = "".join(f"<Link value={quoteattr(name)}/>" for name in names)
    return "App::PropertyLinkList", f'<LinkList count="{len(names)}">{listed}</LinkList>'


def sub(name: str, *paths: str) -> tuple[str, str]:
    listed = "".join(f"<Sub value={quoteattr(path)}/>" for path in paths)
    return (
        "App::PropertyXLinkSubHidden",
        f'<XLink file="" stamp="" name={quoteattr(name)} count="{len(paths)}">{listed}</XLink>',
    )


def shape(file: str) -> tuple[str, str]:
    return "Part::PropertyPartShape", f'<Part ElementMap="0.4" file={quoteattr(file)}/>'


def xml(objects: Mapping[str, tuple[str, Properties]], version: str = "1.0R") -> str:
    """Document.xml of objects by name: type and properties."""
    listed = "".join(
        f'<Object type="{kind}" name={quoteattr(name)} id="1"/>' for name, (kind, _) in objects.items()
    )
    data = ""
    for name, (_, properties) in objects.items():
        values = "".join(
            f'<Property name="{key}" type="{kind}">{value}</Property>'
            for key, (kind, value) in properties.items()
        )
        data += f'<Object name={quoteattr(name)}><Properties Count="{len(properties)}">{values}</Properties></Object>'
    return (
        f'<?xml version="1.0" encoding="utf-8"?>\n<Document SchemaVersion="4" ProgramVersion="{version}" FileVersion="1">'
        f'<Objects Count="{len(objects)}">{listed}</Objects><ObjectData Count="{len(objects)}">{data}</ObjectData></Document>\n'
    )


def document(
    objects: Mapping[str, tuple[str, Properties]], version: str = "1.0R", **members: bytes | str
) -> bytes:
    return archive({"Document.xml": xml(objects, version), **members})


def joint(kind: str, first: str, second: str, **more: tuple[str, str]) -> tuple[str, Properties]:
    """A joint between two paths below the assembly, their frames those of the objects."""
    given: dict[str, tuple[str, str]] = {
        "JointType": word(kind), "Reference1": sub("Assembly", first, first), "Reference2": sub("Assembly", second, second),
        "Placement1": placement(), "Placement2": placement(), "Activated": flag(True),
    }  # fmt: skip
    return "App::FeaturePython", {**given, **more}


def assembly(
    parts: Mapping[str, tuple[str, Properties]], joints: Mapping[str, tuple[str, Properties]], **more: object
):
    """An assembly of parts and joints; the first part is grounded."""
    first = next(iter(parts))
    ground = ("App::FeaturePython", {"ObjectToGround": ("App::PropertyLink", f'<Link value="{first}"/>')})
    return {
        "Assembly": ("Assembly::AssemblyObject", {"Group": links("Joints", *parts), "Label": text("Assembly")}),
        "Joints": ("Assembly::JointGroup", {"Group": links("Ground", *joints)}),
        **parts, "Ground": ground, **joints, **more,
    }  # fmt: skip


def part(**more: tuple[str, str]) -> tuple[str, Properties]:
    return "App::Part", {"Placement": placement(), **more}


def asmt(sets: str) -> bytes:
    """An ``.asmt`` of one part, with these constraint sets."""
    at = "{0}Position3D\n{0}\t0 0 0\n{0}RotationMatrix\n{0}\t1 0 0\n{0}\t0 1 0\n{0}\t0 0 1\n"
    part = f"\tParts\n\t\tPart\n\t\t\tName\n\t\t\t\tBlock\n{at.format(3 * chr(9))}"
    return (
        f"OndselSolver\nAssembly\n\tName\n\t\tA\n{at.format(chr(9))}{part}\tConstraintSets\n{sets}".encode()
    )


CASES: dict[str, tuple[bytes, list[tuple[str, str, str]]]] = {
    "archive-refused.FCStd": (
        b"no zip at all\n", [("ARCHIVE_REFUSED", "error", "archive-refused.FCStd")],
    ),
    "xml-refused.FCStd": (
        archive({"Document.xml": '<!DOCTYPE Document [<!ENTITY a "b">]>\n<Document>&a;</Document>\n'}),
        [("XML_REFUSED", "error", "xml-refused.FCStd/Document.xml:1")],
    ),
    "freecad-value.FCStd": (
        document(assembly({"Base": part(Placement=placement(x="nan"))}, {})),
        [("FREECAD_VALUE", "warning", "freecad-value.FCStd#Base")],
    ),
    "freecad-link-broken.FCStd": (
        document(assembly({"Base": part(), "Far": ("App::Link", {"LinkedObject": link("Body", "../../far.FCStd")})}, {})),
        [("FREECAD_LINK_BROKEN", "warning", "freecad-link-broken.FCStd#Far")],
    ),
    "freecad-joint-dropped.FCStd": (
        document(assembly({"Base": part(), "Arm": part()}, {"Hinge": joint("Revolute", "Base.", "Leg.")})),
        [("FREECAD_JOINT_DROPPED", "warning", "freecad-joint-dropped.FCStd#Hinge")],
    ),
    "shape-not-read.FCStd": (
        document(assembly({"Base": ("Part::Feature", {"Shape": shape("Base.Shape.brp")})}, {})),
        [("SHAPE_NOT_READ", "warning", "shape-not-read.FCStd#Base")],
    ),
    "asmt-syntax.asmt": (
        b"OndselSolver\nAssembly\n\t\t\tName\n", [("ASMT_SYNTAX", "error", "asmt-syntax.asmt:3")],
    ),
    "asmt-left-out.asmt": (
        asmt("\t\tJoints\n\t\t\tFixedJoint\n\t\t\t\tName\n\t\t\t\t\tBolt\n\t\t\t\tMarkerI\n\t\t\t\t\t/A/Nowhere\n"),
        [("ASMT_LEFT_OUT", "warning", "asmt-left-out.asmt:23"), ("ASMT_ASSUMED", "info", "asmt-left-out.asmt")],
    ),
    "asmt-assumed.asmt": (asmt("\t\tJoints\n"), [("ASMT_ASSUMED", "info", "asmt-assumed.asmt")]),
}  # fmt: skip
"""Content and expected findings of each conformance case: code, severity, place."""


if __name__ == "__main__":
    for name, (content, findings) in CASES.items():
        (FOLDER / name).write_bytes(content)
        lines = ",\n".join(
            "  " + json.dumps(dict(zip(("code", "severity", "where"), one))) for one in findings
        )
        (FOLDER / f"{name.split('.')[0]}.report.json").write_text(f"[\n{lines}\n]\n", encoding="utf-8")
