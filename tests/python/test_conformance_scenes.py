"""Every scene case of the manifest against ``scene.schema.json`` alone: what it accepts and what it leaves to C#; and
against every way in which Python reads scenes."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import kinefab
import pytest
from kinefab.diagnostics import KinefabError, Report, schema_directory
from kinefab.sources import read
from kinefab.views.overview import overview, picture

ROOT = Path(__file__).parents[1] / "conformance"
CASES = [
    case
    for case in json.loads((ROOT / "manifest.json").read_text(encoding="utf-8"))["cases"]
    if case["kind"] == "scene"
]


@pytest.fixture(scope="module")
def schema() -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator(
        json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["path"])
def test_schema_says_what_the_manifest_says(case, schema):
    """The schema accepts or rejects each case as its entry states; broken JSON counts as rejected."""
    try:
        accepts = schema.is_valid(json.loads((ROOT / case["path"]).read_bytes().decode("utf-8")))
    except ValueError:
        accepts = False
    assert ("accepts" if accepts else "rejects") == case["schema"]


def test_schema_is_stricter_than_the_reader_in_three_things_only():
    """Unknown fields are warnings in C#, and python's json stops at a byte order mark and at a binary file; nothing else is
    valid but rejected."""
    stricter = {case["path"] for case in CASES if case["expect"] == "valid" and case["schema"] == "rejects"}
    assert stricter == {
        "invalid/component/unknown_field.kinefab",
        "invalid/scene/unknown_field.kinefab",
        "valid/container/one_file.kinefab",
        "valid/text/byte_order_mark.kinefab",
    }


READERS = {
    "export": lambda path, folder: read(path, Report()),
    "inspect": lambda path, folder: overview(path, True),
    "draw": lambda path, folder: picture(path),
    "view": lambda path, folder: kinefab.view(path, folder / "page.html"),
    "motion": lambda path, folder: kinefab.motion(path),
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["path"])
@pytest.mark.parametrize("reader", READERS)
def test_every_reader_refuses_what_the_validator_refuses(case, reader, tmp_path):
    """With the same errors: code, severity and place in the file, as the case's report has them.  There is no exception: the
    limits that C# sets by itself, bytes and items of a file, have no case.  What is valid is read, whatever C# warns of."""
    path = ROOT / case["path"]
    if case["expect"] == "valid":
        assert READERS[reader](path, tmp_path)
        return
    with pytest.raises(KinefabError) as raised:
        READERS[reader](path, tmp_path)
    report = json.loads(path.with_suffix(".report.json").read_text(encoding="utf-8"))
    expected = [(entry["code"], "error", f"{path}#{entry['pointer']}".rstrip("#")) for entry in report]
    assert [(d.code, d.severity.value, d.where) for d in raised.value.diagnostics] == expected


def _without(document, section):
    """The scene once less each field of a section, deeper ones too, with the field's place."""
    for place, holder in _holders(document[section]):
        for key in list(holder):
            value = holder.pop(key)
            yield f"{place}/{key}", document
            holder[key] = value


def _holders(value, place=""):
    if isinstance(value, dict):
        yield place, value
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from _holders(inner, f"{place}/{key}")


def test_what_an_analysis_need_not_state_may_be_left_out(schema, tmp_path):
    """The schema asks for the mobility alone: what another program writes is read, and written again as it is."""
    document = json.loads((ROOT / "valid/scene/every_section.kinefab").read_text(encoding="utf-8"))
    path, again = tmp_path / "less.kinefab", tmp_path / "again.kinefab"
    left_out = 0
    for place, less in _without(document, "analysis"):
        if not schema.is_valid(less):
            continue
        path.write_text(json.dumps(less), encoding="utf-8")
        kinefab.export(path, again)
        written = json.loads(again.read_text(encoding="utf-8"))["analysis"]
        for key in ("mobility", "firstOrderMobility", "redundant", "closureGap"):
            if not place.startswith("/closureGap"):
                assert written.get(key) == less["analysis"].get(key), place
        left_out += 1
    assert left_out >= 9


def test_a_set_of_texture_coordinates_behind_one_that_is_not_there_keeps_its_number(tmp_path):
    """Unity reads zeros from the one that is not there."""
    case = ROOT / "valid/mesh/uv_sets.kinefab"
    document = json.loads(case.read_text(encoding="utf-8"))
    meshes = read(case, Report()).written.meshes
    del document["meshes"][0]["uv2"]
    path = tmp_path / "gap.kinefab"
    path.write_text(json.dumps(document), encoding="utf-8")
    for entry in document["buffers"]:
        (tmp_path / entry["uri"]).write_bytes((case.parent / entry["uri"]).read_bytes())
    found = read(path, Report()).written.meshes[0].uvs
    assert len(found) == len(meshes[0].uvs)
    for i, (uv, whole) in enumerate(zip(found, meshes[0].uvs)):
        assert (uv == (0.0 if i == 1 else whole)).all()


def test_a_mesh_whose_one_submesh_is_empty_is_written_again(tmp_path):
    case = ROOT / "valid/mesh/uv_sets.kinefab"
    document = json.loads(case.read_text(encoding="utf-8"))
    (submesh,) = document["meshes"][0]["submeshes"]
    submesh["indexCount"] = 0
    path, again = tmp_path / "empty.kinefab", tmp_path / "again.kinefab"
    path.write_text(json.dumps(document), encoding="utf-8")
    for entry in document["buffers"]:
        (tmp_path / entry["uri"]).write_bytes((case.parent / entry["uri"]).read_bytes())
    kinefab.export(path, again)
    (mesh,) = read(again, Report()).written.meshes
    assert mesh.submeshes == (0,)
    assert len(mesh.triangles) == 0
    assert (mesh.vertices == read(case, Report()).written.meshes[0].vertices).all()


def test_nothing_is_written_of_a_scene_that_the_validator_refuses(tmp_path):
    with pytest.raises(KinefabError, match="ID_DUPLICATE"):
        kinefab.export(ROOT / "invalid/gameobject/id_twice.kinefab", tmp_path / "again.kinefab")
    assert not list(tmp_path.iterdir())


def _told(path):
    with pytest.raises(KinefabError) as raised:
        read(path, Report())
    return sorted((d.code, d.where.removeprefix(str(path))) for d in raised.value.diagnostics)


def test_faults_of_buffers_and_of_the_text_are_told_at_once(tmp_path):
    """As C# tells them: who mends a file sees all that is wrong with it."""
    lever = ROOT.parents[1] / "fixtures" / "lever"
    document = json.loads((lever / "lever.kinefab").read_text("utf-8"))
    content = (lever / document["buffers"][0]["uri"]).read_bytes()
    document["gameObjects"][1]["parent"] = 1
    document["meshes"][0]["submeshes"][0]["indexStart"] = 3
    document["meshes"][1]["vertexCount"] = 1
    path, parent = tmp_path / "damaged.kinefab", ("PARENT_NOT_EARLIER", "#/gameObjects/1/parent")
    path.write_text(json.dumps(document), "utf-8")
    gap = ("SUBMESH_GAP", "#/meshes/0/submeshes/0/indexStart")
    assert _told(path) == sorted([parent, gap, ("BUFFER_MISSING", "#/buffers/0/uri")])
    beside = tmp_path / document["buffers"][0]["uri"]
    beside.write_bytes(content[:-4])
    assert _told(path) == sorted([parent, gap, ("BUFFER_SIZE", "#/buffers/0/byteLength")])
    beside.write_bytes(bytes([content[0] ^ 1]) + content[1:])
    assert _told(path) == sorted([parent, gap, ("BUFFER_SHA256", "#/buffers/0/sha256")])
    beside.write_bytes(content)
    assert _told(path) == sorted([parent, gap, ("MESH_INDEX_RANGE", "#/meshes/1/indices")])


def test_what_nobody_could_write_again_is_told_with_what_is_of_another_type(tmp_path):
    """Of a name that stands twice the first one counts."""
    path = tmp_path / "damaged.kinefab"
    path.write_text(
        '{"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a", "name": 3, "name": "A", "extras": '
        f'{{"many": 1{"0" * 400}, "\\ud800": [1e400, "\\udfff"]}}}}]}}',
        "utf-8",
    )
    extras = "#/gameObjects/0/extras"
    assert _told(path) == sorted([
        ("FIELD_DUPLICATE", "#/gameObjects/0/name"),
        ("JSON_STRING_INVALID", rf"{extras}/\ud800"),
        ("JSON_STRING_INVALID", rf"{extras}/\ud800/1"),
        ("NUMBER_NOT_FINITE", f"{extras}/many"),
        ("NUMBER_NOT_FINITE", rf"{extras}/\ud800/0"),
        ("TYPE_MISMATCH", "#/gameObjects/0/name"),
    ])  # fmt: skip
    path.write_text('{"format": "of.another", "version": "1.0", "gameObjects": [1e400]}', "utf-8")
    assert _told(path) == [("FORMAT_UNKNOWN", "#/format")]
