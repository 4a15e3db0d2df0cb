"""Every document that a prefab consists of has the fields of its class in the editor it is for: these, in this order, of this
kind; every reference leads somewhere.  The table (``data/unity_classes.json``) is that of the editors' own type trees."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import FIXTURES
from kinefab import model
from kinefab.targets.prefab.text.ids import FileIds, guid, xxh64
from kinefab.targets.prefab.text.yaml import number, text
from prefab_reader import BUILT_IN, Project, vector
from prefab_scenes import rich_scene
from unity_yaml import Document, Scalar, documents, mapping

TABLE = json.loads((Path(__file__).parent / "data" / "unity_classes.json").read_text("utf-8"))
DIALECTS = tuple(TABLE)
PIPELINES = ("builtin", "urp", "hdrp")
NATIVE = {".asset": ("Mesh", 4300000), ".mat": ("Material", 2100000), ".anim": ("AnimationClip", 7400000)}


@cache
def exported(folder: Path, dialect: str, pipeline: str, scripts: bool = False) -> Path:
    target = folder / f"rich_{dialect}_{pipeline}" / "Rich.prefab"
    target.parent.mkdir()
    writing = {"unity": dialect, "pipeline": pipeline, "scripts": scripts}
    kinefab.export(rich_scene(folder), target, kinefab.ExportOptions(writing=writing))
    return target


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("rich")


def disagreements(value, rule, where: str, exact: bool = True) -> list[str]:
    """What a value has otherwise than its class's table says."""
    if isinstance(rule, dict):
        if not isinstance(value, dict):
            return [f"{where}: {value!r} for a block"]
        found = (
            [] if list(value) == list(rule) else [f"{where}: {sorted(set(value) ^ set(rule)) or list(value)}"]
        )
        return found + [
            d for k in value if k in rule for d in disagreements(value[k], rule[k], f"{where}.{k}")
        ]
    if isinstance(rule, int):
        return [] if value == str(rule) else [f"{where}: version {value}"]
    if isinstance(rule, list):
        if rule[0] == "list":
            bad = [] if isinstance(value, list) else [f"{where}: {value!r} for a list"]
            return bad or [d for i, v in enumerate(value) for d in disagreements(v, rule[1], f"{where}[{i}]")]
        pairs = [value] if isinstance(value, dict) else value
        bad = (
            []
            if isinstance(pairs, list) and all(isinstance(p, dict) for p in pairs)
            else [f"{where}: {value!r}"]
        )
        return bad or [
            d for p in pairs for k, v in p.items() for d in disagreements(v, rule[2], f"{where}.{k}")
        ]
    if rule.startswith("{"):
        right = (
            isinstance(value, dict) and "".join(value) == rule[1:-1] and all(map(is_float, value.values()))
        )
    elif rule == "reference":
        keys = list(value) if isinstance(value, dict) else []
        right = keys in (["fileID"], ["fileID", "guid", "type"]) and re.fullmatch(r"-?\d+", value["fileID"])
    elif rule == "int":
        right = isinstance(value, Scalar) and re.fullmatch(r"-?\d+", value)
    elif rule == "float":
        right = isinstance(value, Scalar) and is_float(value)
    elif rule == "hex":
        right = isinstance(value, Scalar) and re.fullmatch(r"([0-9a-f]{2})*", value)
    else:
        right = isinstance(value, Scalar)
    return [] if right else [f"{where}: {value!r} for {rule}"]


def is_float(value: str) -> bool:
    """In as few digits as tell the float32 from its neighbours, in the editor's form."""
    if value in ("Infinity", "-Infinity"):
        return True
    if not re.fullmatch(r"-?(0|[1-9]\d*)(\.\d*[1-9])?(e[+-][1-9]\d*)?", value) or value == "-0":
        return False
    digits = re.sub(r"e.*|[-.]", "", value).strip("0")
    shortest = np.format_float_scientific(np.float32(value), trim="-").split("e")[0]
    return digits == re.sub(r"[-.]", "", shortest).strip("0")


def all_documents(prefab: Path) -> list[tuple[Path, Document]]:
    files = [
        prefab,
        *(p for p in sorted(prefab.with_suffix("").rglob("*")) if p.suffix in (*NATIVE, ".physicMaterial")),
    ]
    return [(path, d) for path in files for d in documents(path.read_text("utf-8"))]


@pytest.mark.parametrize("dialect", DIALECTS)
def test_clips_move_bodies_in_step_with_the_solver(folder, dialect):
    """By whichever field the editor looks at."""
    (own,) = [
        d.fields for _, d in all_documents(exported(folder, dialect, "builtin")) if d.kind == "Animation"
    ]
    asked = {name: value for name, value in own.items() if name in ("m_AnimatePhysics", "m_UpdateMode")}
    assert len(asked) == (2 if dialect == "6" else 1) and set(asked.values()) == {"1"}


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_every_document_has_the_fields_of_its_class(folder, dialect, pipeline):
    found = all_documents(exported(folder, dialect, pipeline))
    assert {d.kind for _, d in found} >= set(TABLE[dialect]) - {"ArticulationBody", "MonoBehaviour"}
    for path, document in found:
        rule = TABLE[dialect][document.kind]
        assert document.class_id == rule["classID"]
        assert not document.stripped
        fields = rule["fields"] | (
            {"version": "int"} if path.suffix == ".mat" and document.class_id == 114 else {}
        )
        assert disagreements(document.fields, fields, f"{path.name} {document.kind}") == []


def references(value) -> list[dict]:
    if isinstance(value, dict):
        return [value] if "fileID" in value else [r for v in value.values() for r in references(v)]
    return [r for v in value for r in references(v)] if isinstance(value, list) else []


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_reference_leads_to_what_it_says(folder, dialect):
    prefab = exported(folder, dialect, "urp")
    project = Project(prefab.parent)
    wanted = {
        "m_GameObject": "GameObject", "m_Father": "Transform", "m_Children": "Transform", "m_ConnectedBody": "Rigidbody",
        "m_Mesh": "Mesh", "m_Materials": "Material", "m_Material": "Material", "m_Animation": "AnimationClip",
        "m_Animations": "AnimationClip", "component": None, "m_Component": None, "m_Shader": None, "m_SavedProperties": None,
    }  # fmt: skip
    for path in {path for path, _ in all_documents(prefab)}:
        own = {str(d.file_id): d for d in documents(path.read_text("utf-8"))}
        for document in own.values():
            for key, value in document.fields.items():
                for reference in references(value):
                    if reference["fileID"] == "0":
                        assert "guid" not in reference
                        continue
                    if "guid" not in reference:
                        target = own[reference["fileID"]]
                    elif reference["guid"] in BUILT_IN:
                        continue
                    elif reference["type"] == "3":
                        assert (
                            project.paths[reference["guid"]].suffix == ".png"
                            and reference["fileID"] == "2800000"
                        )
                        continue
                    else:
                        target = project.asset(reference)
                    kind = wanted[key]
                    if key == "m_Material":
                        assert target.kind in ("PhysicMaterial", "PhysicsMaterial")
                    elif kind is not None:
                        assert target.kind == kind


def test_game_objects_rise_and_components_follow(folder):
    """As the editor writes them, so that what it saves differs by little."""
    found = documents(exported(folder, "2022", "builtin").read_text("utf-8"))
    ids = [d.file_id for d in found]
    assert len(set(ids)) == len(ids) and min(ids) > 0 and max(ids) < 1 << 63
    objects = [d for d in found if d.kind == "GameObject"]
    assert [d.file_id for d in objects] == sorted(d.file_id for d in objects)
    order = [
        x
        for d in objects
        for x in (d.file_id, *(int(c["component"]["fileID"]) for c in d.fields["m_Component"]))
    ]
    assert order == ids
    assert all(found[i + 1].kind == "Transform" for i, d in enumerate(found) if d.kind == "GameObject")


def test_every_file_has_a_meta_of_its_importer(folder):
    prefab = exported(folder, "2022", "hdrp")
    project = Project(prefab.parent)
    there = {p for p in prefab.parent.rglob("*") if p.suffix != ".meta" and not p.name.startswith(".")}
    assert set(project.paths.values()) == there
    for path in there:
        meta = mapping(Path(f"{path}.meta").read_text("utf-8"))
        keys = [k for k in meta if k.endswith("Importer")]
        assert re.fullmatch("[0-9a-f]{32}", meta["guid"]) and list(meta)[:2] == ["fileFormatVersion", "guid"]
        if path.suffix in NATIVE:
            assert keys == ["NativeFormatImporter"]
            assert meta["NativeFormatImporter"]["mainObjectFileID"] == str(NATIVE[path.suffix][1])
        elif path.is_dir():
            assert meta["folderAsset"] == "yes" and keys == ["DefaultImporter"]
        else:
            assert keys == [
                {".prefab": "PrefabImporter", ".png": "TextureImporter"}.get(
                    path.suffix, "NativeFormatImporter"
                )
            ]


IMPORTED = [
    ("Shader", "MainAsset", -6465566751694194690),
    ("GameObject", "scenes/Scene/Scene", 8771091787928289351),
    ("Transform", "scenes/Scene/Scene/Transform", -3910990755373119420),
    ("PrefabInstance", "scenes/Scene", -4161369568681901532),
    ("GameObject", "//RootNode/root", 919132149155446097),
    ("Transform", "//RootNode/root/Transform", -8679921383154817045),
]
"""fileIDs that editors gave, in public projects."""


@pytest.mark.parametrize("kind, identifier, known", IMPORTED)
def test_the_hash_is_that_of_unity(kind, identifier, known):
    found = xxh64(f"Type:{kind}->{identifier}0".encode())
    assert found % 2**64 == known % 2**64


def test_xxhash_of_every_length():
    """The published values for no byte and for short ones; and every length against the reference where it is installed."""
    assert xxh64(b"") == 0xEF46DB3751D8E999
    assert xxh64(b"a") == 0xD24EC4F1A98C6E5B
    assert xxh64(b"abc") == 0x44BC2CF5AD770999
    xxhash = pytest.importorskip("xxhash")
    for length in range(100):
        data = bytes((7 * i * i + length) % 256 for i in range(length))
        assert xxh64(data) == xxhash.xxh64_intdigest(data)


def test_file_ids_are_positive_and_each_once():
    ids = FileIds()
    found = [ids.new("GameObject", name) for name in ("a", "b", "a", "ä\udc80")]
    assert len(set(found)) == 4 and all(0 < i < 1 << 63 for i in found)
    assert FileIds().new("GameObject", "a") == found[0] != FileIds().new("Transform", "a")
    assert guid("x", "y") != guid("xy") and re.fullmatch("[0-9a-f]{32}", guid("x"))


@pytest.mark.parametrize(
    "value, written",
    [
        (0.05, "0.05"), (-1.7053026e-15, "-1.7053026e-15"), (3.4028233e38, "3.4028233e+38"), (float("inf"), "Infinity"), (-0.0, "0"),
        (1 / 3, "0.33333334"), (0.00021080486, "0.00021080486"), (-1.1533758e-9, "-0.0000000011533758"), (1e39, "Infinity"),
        (-3.037139e-10, "-3.037139e-10"), (16777216.0, "16777216"), (123456789.0, "123456790"), (0.1 + 0.2, "0.3"), (1e-50, "0"),
    ],
)  # fmt: skip
def test_numbers_are_written_as_the_editor_does(value, written):
    assert number(value) == written


@pytest.mark.parametrize(
    "value, written",
    [
        ("Cube", "Cube"), ("Bolt:1", "Bolt:1"), ("Scale: 2", "'Scale: 2'"), ("Cactus ", "'Cactus '"), ("", ""), ("a 'b'", "a 'b'"),
        ("'a'", "'''a'''"), ("- a", "'- a'"), ("-a", "-a"), ("a:", "'a:'"), ("[x]", "'[x]'"), ("\uf702UI", '"\\uF702UI"'),
        ("Größe", '"Gr\\xF6\\xDFe"'), ("😀", '"\\U0001F600"'), ("a\nb", '"a\\nb"'), ('q"\\', 'q"\\'), ("x #y", "'x #y'"),
    ],
)  # fmt: skip
def test_text_is_quoted_as_the_editor_does(value, written):
    assert text(value) == written


def test_fixtures_of_every_kind_keep_to_the_table(tmp_path):
    """The lever from its bundle, and every golden mechanism's components, not only the scene made for it."""
    for name in ("lever/lever", "mechanisms/M12", "mechanisms/M45", "pairs/P17"):
        target = tmp_path / f"{Path(name).name}.prefab"
        kinefab.export(FIXTURES / f"{name}.bundle.json", target)
        for path, document in all_documents(target):
            assert disagreements(document.fields, TABLE["2022"][document.kind]["fields"], path.name) == []


def test_between_two_keys_a_turn_runs_along_the_great_arc(tmp_path):
    """As Unity plays the curves: each number a cubic of Hermite, the quaternion made one again."""
    times, half = np.array([0.5, 2.5, 3.0]), np.radians([0.0, 80.0, -5.0])  # of the angles 0, 160 and -10
    axis = np.array([2.0, -3.0, 6.0]) / 7.0
    turns = np.column_stack([np.sin(half)[:, None] * axis, np.cos(half)])
    clip = model.AnimationClip("Turn", times, (model.Track(0, rotations=turns),))
    scene = model.Scene([model.Node("A", "A")], animations=[clip])
    kinefab.export(scene, tmp_path / "a.prefab")
    (found,) = documents(next(tmp_path.rglob("*.anim")).read_text("utf-8"))
    (curve,) = found.fields["m_RotationCurves"]
    keys = curve["curve"]["m_Curve"]
    assert [float(key["time"]) for key in keys] == times.tolist()
    numbers = {n: np.array([vector(key[n]) for key in keys]) for n in ("value", "inSlope", "outSlope")}
    for i, (start, end) in enumerate(zip(times, times[1:])):
        for u in np.linspace(0.0, 1.0, 17):
            played = (
                (2 * u**3 - 3 * u**2 + 1) * numbers["value"][i]
                + (u**3 - 2 * u**2 + u) * (end - start) * numbers["outSlope"][i]
                + (3 * u**2 - 2 * u**3) * numbers["value"][i + 1]
                + (u**3 - u**2) * (end - start) * numbers["inSlope"][i + 1]
            )
            at = half[i] + u * (half[i + 1] - half[i])
            wanted = np.append(np.sin(at) * axis * (1.0, -1.0, -1.0), np.cos(at))
            cosine = abs(played @ wanted) / np.linalg.norm(played)
            assert 2 * np.degrees(np.arccos(min(1.0, cosine))) < 0.3, (i, u)


def test_a_step_between_two_keys_of_a_clip_stays_one(tmp_path):
    """Two keys that 32 bits hold at one time would be one to the editor."""
    slide = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.0, 0.0]])
    clip = model.AnimationClip("Step", np.array([0.0, 100.0, 100.0 + 1e-9, 200.0]), (model.Track(0, slide),))
    kinefab.export(model.Scene([model.Node("A", "A")], animations=[clip]), tmp_path / "A.prefab")
    (found,) = documents(next(tmp_path.rglob("*.anim")).read_text("utf-8"))
    keys = found.fields["m_PositionCurves"][0]["curve"]["m_Curve"]
    times = [np.float32(key["time"]) for key in keys]
    assert times == sorted(set(times)) and np.allclose(times, clip.times, rtol=1e-6)
