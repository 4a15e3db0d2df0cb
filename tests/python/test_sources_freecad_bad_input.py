"""Damaged FreeCAD documents and assemblies: a diagnostic, never a traceback, a hang or a file that was not asked for.

``KINEFAB_MUTATIONS=5000`` runs that many mutations of each format instead of a few.
"""

from __future__ import annotations

import io
import os
import random
import re
import zipfile

import pytest
from freecad_files import archive, assembly, document, joint, link, links, part, placement, shape, text
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from source_bundles import FIXTURES

FREECAD = FIXTURES / "freecad"
MUTATIONS = int(os.environ.get("KINEFAB_MUTATIONS", "120"))


def read(path):
    """The scene, or None where it is refused, and the codes."""
    report = Report()
    try:
        scene = sources.read(path, report)
    except KinefabError as error:
        assert error.diagnostics
        scene = None
    return scene, [d.code for d in report.diagnostics]


def members(name: str) -> dict[str, bytes]:
    with zipfile.ZipFile(FREECAD / name) as file:
        return {member: file.read(member) for member in file.namelist()}


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Bytes with one to four faults: flipped, cut, doubled, swapped, or another value between two quotes."""
    for _ in range(chance.randint(1, 4)):
        if not data:
            return data
        at, kind = chance.randrange(len(data)), chance.randrange(7)
        span = chance.choice((1, 2, 8, 60, 400))
        if kind == 0:
            data = data[:at] + bytes([chance.randrange(256)]) + data[at + 1 :]
        elif kind == 1:
            data = data[:at] + data[at + span :]
        elif kind == 2:
            data = data[:at] + data[at : at + span] + data[at:]
        elif kind == 3:
            data = data[:at] if chance.random() < 0.2 else data[:at] + data[at + 1 :]
        else:
            quoted = [match.span(1) for match in re.finditer(rb'"([^"\n]{0,60})"', data)]
            if quoted:
                start, end = chance.choice(quoted)
                value = chance.choice(
                    (
                        b"",
                        b"-1",
                        b"nan",
                        b"1e308",
                        b"999999999",
                        b"Base",
                        b"Assembly",
                        b"../x",
                        b"true",
                        b"\xff",
                    )
                )
                data = data[:start] + value + data[end:]
    return data


@pytest.mark.parametrize("name", ["linked.FCStd", "couplings.FCStd", "revolute.FCStd"])
def test_mutations_of_the_xml(tmp_path, name):
    given = {key: value for key, value in members(name).items() if not key.endswith(".brp")}
    chance = random.Random(name)
    for _ in range(MUTATIONS // 3):
        changed = {**given, "Document.xml": damaged(given["Document.xml"], chance)}
        (tmp_path / name).write_bytes(archive(changed))
        read(tmp_path / name)


def test_mutations_of_the_zip(tmp_path):
    given, chance = (FREECAD / "revolute.FCStd").read_bytes(), random.Random(2)
    for _ in range(MUTATIONS):
        (tmp_path / "a.FCStd").write_bytes(damaged(given, chance))
        read(tmp_path / "a.FCStd")


def test_mutations_of_the_shapes(tmp_path):
    """OpenCASCADE may crash over them, in its own process; the mechanism is read all the same."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: pip install cadquery-ocp-novtk")
    given, chance = members("revolute.FCStd"), random.Random(3)
    for _ in range(max(10, MUTATIONS // 10)):
        changed = {**given, "Arm.Shape.brp": damaged(given["Arm.Shape.brp"], chance)}
        (tmp_path / "a.FCStd").write_bytes(archive(changed))
        scene, _ = read(tmp_path / "a.FCStd")
        assert scene is not None and len(scene.joints) == 1


def test_mutations_of_an_asmt(tmp_path):
    chance = random.Random(4)
    files = [
        (FREECAD / f"{name}.asmt").read_bytes() for name in ("couplings", "cylindrical", "distance_points")
    ]
    for _ in range(MUTATIONS):
        (tmp_path / "a.asmt").write_bytes(damaged(chance.choice(files), chance))
        read(tmp_path / "a.asmt")


def test_a_bomb_is_not_unpacked(tmp_path, monkeypatch):
    from kinefab.sources.freecad import archive as limits

    monkeypatch.setattr(limits, "MAX_MEMBER", 2**20)
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("Document.xml", b" " * (2**20 + 1))
    assert len(bomb.getvalue()) < 2**12
    (tmp_path / "a.FCStd").write_bytes(bomb.getvalue())
    assert read(tmp_path / "a.FCStd") == (None, ["ARCHIVE_REFUSED"])


def test_links_that_unfold_without_end_are_refused(tmp_path):
    """Twenty levels of ten links each: a small file, and more parts than there are grains of sand."""
    objects = {}
    for level in range(20):
        names = [f"L{level}_{k}" for k in range(10)]
        for name in names:
            objects[name] = ("App::Link", {"LinkedObject": link(f"P{level + 1}")})
        objects[f"P{level}"] = ("App::Part", {"Group": links(*names)})
    objects["P20"] = part()
    (tmp_path / "a.FCStd").write_bytes(document(objects))
    assert read(tmp_path / "a.FCStd") == (None, ["ARCHIVE_REFUSED"])


def test_a_link_to_itself_is_reported(tmp_path):
    objects = assembly({"Base": part(), "A": ("App::Link", {"LinkedObject": link("B")})}, {})
    objects["B"] = ("App::Part", {"Group": links("A")})
    (tmp_path / "a.FCStd").write_bytes(document(objects))
    scene, codes = read(tmp_path / "a.FCStd")
    assert scene is not None and set(codes) == {"FREECAD_LINK_BROKEN"}


@pytest.mark.parametrize(
    "file",
    ["../far.FCStd", "/etc/passwd", "sub/../../far.FCStd", "..\\far.FCStd", "%2e%2e/far.FCStd", "near.txt"],
)
def test_files_outside_of_the_folder_are_not_opened(tmp_path, file):
    """Nor any that is no document; the part stays without geometry, and the mechanism with it."""
    inside = tmp_path / "inside"
    (inside / "sub").mkdir(parents=True)
    (tmp_path / "far.FCStd").write_bytes(document({"Body": part()}))
    (inside / "near.txt").write_bytes(document({"Body": part()}))
    objects = assembly({"Base": part(), "Arm": ("App::Link", {"LinkedObject": link("Body", file), "Placement": placement(x=5)})},
                       {"Hinge": joint("Revolute", "Base.", "Arm.")})  # fmt: skip
    (inside / "a.FCStd").write_bytes(document(objects))
    scene, codes = read(inside / "a.FCStd")
    assert codes == ["FREECAD_LINK_BROKEN"] and len(scene.joints) == 1
    assert scene.source.files == ()


def test_a_symbolic_link_does_not_lead_out(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "far.FCStd").write_bytes(document({"Body": part()}))
    (inside / "near.FCStd").symlink_to(tmp_path / "far.FCStd")
    objects = assembly(
        {"Base": part(), "Arm": ("App::Link", {"LinkedObject": link("Body", "near.FCStd")})}, {}
    )
    (inside / "a.FCStd").write_bytes(document(objects))
    assert read(inside / "a.FCStd")[1] == ["FREECAD_LINK_BROKEN"]


def test_members_are_never_written(tmp_path):
    """A member's name may climb; nothing is unpacked to a disk."""
    objects = assembly(
        {"Base": ("Part::Feature", {"Shape": shape("../../evil.brp"), "Label": text("Base")})}, {}
    )
    (tmp_path / "a.FCStd").write_bytes(document(objects, **{"../../evil.brp": b"no shape"}))
    scene, _ = read(tmp_path / "a.FCStd")
    assert scene is not None and [path.name for path in tmp_path.iterdir()] == ["a.FCStd"]


@pytest.mark.parametrize(
    "content",
    [
        b"OndselSolver\n",
        b"\n" * 50,
        b"\t" * 60 + b"x",
        "OndselSolver\nAssembly\n\tName\n\t\tä\n".encode("latin-1"),
    ],
)
def test_what_is_no_asmt_is_refused(tmp_path, content):
    (tmp_path / "a.asmt").write_bytes(content)
    assert read(tmp_path / "a.asmt")[0] is None
