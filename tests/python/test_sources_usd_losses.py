"""What is wrong with a stage, or cannot be kept of it, is told by a code with its place; nothing raises."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from kinefab.diagnostics import Report
from usd_stages import body, codes, joint, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

MESH = "int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 2]; point3f[] points = [(0,0,0),(1,0,0),(0,1,0)]"
HINGE = joint("PhysicsRevoluteJoint")
REFUSED = {
    "USD_UNREADABLE": "#usda 1.0\ndef Xform {{{",
    "SOURCE_EMPTY": "#usda 1.0\n",
    "USD_UNIT_IMPOSSIBLE": stage(body("B"), metres=-1.0),
    "USD_VALUE_IMPOSSIBLE": stage(body("B", mass="float physics:mass = -2")),
    "USD_VARIANT_UNKNOWN": stage(body("B")),
    "USD_ROOT_UNKNOWN": stage(body("B")),
}
OPTIONS = {"USD_VARIANT_UNKNOWN": {"variant": ("physics=on",)}, "USD_ROOT_UNKNOWN": {"root": "/Nothing"}}


@pytest.mark.parametrize("code", REFUSED)
def test_a_stage_that_cannot_be_read_is_refused(code, tmp_path):
    scene, report = scene_of(tmp_path, REFUSED[code], **OPTIONS.get(code, {}))
    assert scene is None
    assert {d.code for d in report.diagnostics if d.severity.value == "error"} == {code}
    assert all(d.where for d in report.diagnostics)


@pytest.mark.parametrize("metres", ["1e-320", "1e300"])
def test_units_at_the_ends_of_what_floats_hold_are_none(tmp_path, metres):
    text = stage(body("B")).replace("metersPerUnit = 1", f"metersPerUnit = {metres}")
    assert metres in text
    scene, report = scene_of(tmp_path, text)
    assert scene is None and codes(report) == {"USD_UNIT_IMPOSSIBLE"}


def test_time_codes_that_take_no_time_are_refused(tmp_path):
    """In a sublayer or above one pxr counts their samples without end."""
    more = "timeCodesPerSecond = 0"
    (tmp_path / "keys.usda").write_text(stage("", more=more), encoding="utf-8")
    for text in (stage(body("B"), more=more), stage(body("B"), more="subLayers = [@keys.usda@]")):
        scene, report = scene_of(tmp_path, text)
        assert scene is None and codes(report) == {"USD_UNIT_IMPOSSIBLE"}


def test_what_a_joint_names_beside_the_root_stands_somewhere(tmp_path):
    """It is not walked over, and its place may be as wrong as any."""
    off = 'def Xform "Off" { double3 xformOp:translate = (nan, 0, 0)\n uniform token[] xformOpOrder = ["xformOp:translate"]\n }\n'
    inside = body("B") + joint("PhysicsRevoluteJoint", body0="/Off", body1="/R/B")
    scene, report = scene_of(tmp_path, stage(off + f'def Xform "R" {{\n{inside}\n}}'), root="/R")
    assert scene is None and codes(report) == {"USD_VALUE_IMPOSSIBLE"}


def test_a_joint_beside_the_root_is_told_where_it_holds_what_is_read(tmp_path):
    """As programs write them that keep all joints in a scope of their own."""
    bodies = f'def Xform "R" {{\n{body("B")}{body("C", (1, 0, 0))}}}\n{body("Other")}'
    inner = joint("PhysicsRevoluteJoint", "J", "", "/R/B", "/R/C")
    other = joint("PhysicsRevoluteJoint", "K", "", "", "/Other")
    scene, report = scene_of(tmp_path, stage(f'{bodies}def Scope "Joints" {{\n{inner}{other}}}'), root="/R")
    assert scene is not None and not scene.joints
    assert [(o.feature, o.outcome.value) for o in report.outcomes] == [("joint /Joints/J", "dropped")]
    assert "holds /R/B" in report.diagnostics[0].message


def test_a_joint_below_the_root_to_a_body_beside_it_is_told(tmp_path):
    """The world stands in for the body; for what stands still beside the root it does so rightly."""
    inner = joint("PhysicsRevoluteJoint", "J", "", "/Other", "/R/B")
    still = joint("PhysicsRevoluteJoint", "K", "", "/Wall", "/R/C")
    inside = f'def Xform "R" {{\n{body("B")}{body("C", (1, 0, 0))}{inner}{still}}}\n'
    scene, report = scene_of(tmp_path, stage(inside + body("Other") + 'def Cube "Wall" {}\n'), root="/R")
    assert scene is not None and [j.a for j in scene.joints] == [None, None]
    (told,) = report.outcomes
    assert (told.feature, told.outcome.value) == ("joint R/J", "approximated")
    assert "the world stands in for /Other" in report.diagnostics[0].message
    whole, report = scene_of(tmp_path, stage(inside + body("Other") + 'def Cube "Wall" {}\n'))
    assert whole is not None and not report.outcomes


def test_physics_materials_of_subsets_are_one_and_the_others_are_told(tmp_path):
    """Faces of brass and of steel, and one whose mesh has a material of its own."""
    materials = "".join(
        f'def Material "{name}" (prepend apiSchemas = ["PhysicsMaterialAPI"]) {{ float physics:dynamicFriction = {friction}\n}}\n'
        for name, friction in (("Brass", 0.3), ("Steel", 0.7), ("Wood", 0.9))
    )
    subset = 'def GeomSubset "{0}" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ uniform token elementType = "face"\n int[] indices = [{1}]\n rel material:binding:physics = </{0}>\n }}\n'
    faces = "int[] faceVertexCounts = [3, 3, 3, 3]; int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]; point3f[] points = [(0,0,0),(1,0,0),(0,2,0),(0,0,3)]\n"
    mesh = 'def Mesh "{0}" (prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "MaterialBindingAPI"]) {{\n{1}{2}}}\n'
    both = (
        faces
        + 'uniform token subdivisionScheme = "none"\nuniform token physics:approximation = "convexHull"\n'
        + subset.format("Brass", "0, 1")
        + subset.format("Steel", "2")
    )
    inside = mesh.format("M", both, "") + mesh.format("N", both, "rel material:binding:physics = </Wood>\n")
    scene, report = scene_of(tmp_path, stage(body("B", inside=inside) + materials))
    assert [c.material.dynamic_friction for c in scene.nodes[0].colliders] == pytest.approx([0.3, 0.9])
    assert [o.feature for o in report.outcomes if o.outcome.value == "dropped"] == [
        "physics material Steel of /B/M/Steel", "physics material Brass of /B/N/Brass", "physics material Steel of /B/N/Steel",
    ]  # fmt: skip


def test_a_mass_of_what_does_not_weigh_is_told(tmp_path):
    """Of a wall, of a group within a body and of what is only drawn there; not of a collider, nor where none is stated."""
    prim = 'def {} "{}" (prepend apiSchemas = [{}"PhysicsMassAPI"]) {{ float physics:{} = {}\n{}\n}}\n'
    collider = prim.format("Cube", "Weighed", '"PhysicsCollisionAPI", ', "mass", 3, "")
    inside = prim.format("Xform", "Group", "", "mass", 7, collider) + prim.format(
        "Cube", "Drawn", "", "density", 500, ""
    )
    wall = prim.format("Cube", "Wall", '"PhysicsCollisionAPI", ', "mass", 9, "")
    unset = prim.format("Cube", "Unset", '"PhysicsCollisionAPI", ', "mass", 0, "")
    scene, report = scene_of(tmp_path, stage(body("B", inside=inside, mass="") + wall + unset))
    assert next(node for node in scene.nodes if node.id == "B").mass.mass == pytest.approx(3.0)
    told = [o.feature for o in report.outcomes if o.outcome.value == "dropped"]
    assert told == ["mass of /B/Group", "mass of /B/Drawn", "mass of /Wall"]


def test_a_name_that_cannot_be_shown_is_told_once(tmp_path):
    """Of a material with two looks, a body and a joint."""
    steering = '"A\\x1b[31mb"'
    shapes = "".join(
        f'def {kind} "{kind}" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ rel material:binding = </M>\n }}\n'
        for kind in ("Sphere", "Cube")
    )
    paint = f'def Material "M" (displayName = {steering}) {{ token outputs:surface.connect = </M/S.outputs:surface>\n def Shader "S" {{ uniform token info:id = "UsdPreviewSurface"; token outputs:surface\n }}\n }}\n'
    moving = body("B", inside=shapes).replace("(prepend", f"(displayName = {steering}\nprepend", 1)
    hinge = HINGE.replace('"J" ', f'"J" (displayName = {steering})', 1)
    scene, report = scene_of(tmp_path, stage(moving + hinge + paint))
    assert (scene.nodes[0].name, scene.joints[0].name, scene.surfaces[0].name) == ("B", "J", "M")
    told = [o.feature for o in report.outcomes if o.code == "USD_FEATURE_APPROXIMATED"]
    assert sorted(told) == ["name of /B", "name of /J", "name of /M"]
    assert all("A\\x1b[31mb" in o.message for o in report.outcomes if o.feature in told)


TOLD = {
    "USD_COMPOSITION": 'def Xform "A" (references = @missing.usda@) {}\n' + body("B"),
    "USD_WITHOUT_BODIES": 'def Sphere "S" {}',
    "USD_TARGET_MISSING": body("B") + joint("PhysicsRevoluteJoint", body0="/Gone"),
    "USD_JOINT_UNKNOWN": body("B") + joint("DistancePhysicsJoint"),
    "USD_JOINT_ENDS_EQUAL": body("B") + joint("PhysicsRevoluteJoint", body0="/B"),
    "USD_FEATURE_DROPPED": body("B") + 'def SphereLight "Sun" {}',
    "USD_FEATURE_APPROXIMATED": body("B") + joint("PhysicsSphericalJoint", inside="float physics:coneAngle0Limit = 30\nfloat physics:coneAngle1Limit = 40"),
    "USD_MASS_ASSUMED": body("B", mass=""),
    "USD_SCALE_ZERO": body("B", inside='def Cube "C" { double3 xformOp:scale = (1, 0, 1)\n uniform token[] xformOpOrder = ["xformOp:scale"]\n }'),
    "USD_MESH_UNSOUND": body("B", inside='def Mesh "M" { int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 7]; point3f[] points = [(0,0,0)]\n }'),
    "USD_PRIMVAR_UNSOUND": body("B", inside=f'def Mesh "M" {{ {MESH}\n normal3f[] normals = [(0,0,1)] (interpolation = "vertex")\n }}'),
    "USD_SUBSET_UNSOUND": body("B", inside=f'def Mesh "M" {{ {MESH}\n def GeomSubset "S" {{ uniform token elementType = "face"; uniform token familyName = "materialBind"; int[] indices = [0, 5]\n }}\n }}'),
    "USD_SUBDIVISION": body("B", inside=f'def Mesh "M" {{ {MESH}\n }}'),
    "USD_DEFORMATION": body("B", inside='def Mesh "M" { int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 2]; point3f[] points.timeSamples = { 0: [(0,0,0),(1,0,0),(0,1,0)], 1: [(0,0,0),(2,0,0),(0,1,0)] }\n }'),
    "USD_MATERIAL_UNKNOWN": body("B", inside='def Sphere "S" (prepend apiSchemas = ["MaterialBindingAPI"]) { rel material:binding = </M>\n }') + 'def Material "M" { token outputs:mdl:surface.connect = </M/S.outputs:out>\n def Shader "S" { token outputs:out\n }\n }',
    "USD_TEXTURE_MISSING": body("B", inside='def Sphere "S" (prepend apiSchemas = ["MaterialBindingAPI"]) { rel material:binding = </M>\n }') + 'def Material "M" { token outputs:surface.connect = </M/S.outputs:surface>\n def Shader "S" { uniform token info:id = "UsdPreviewSurface"; token outputs:surface; color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>\n }\n def Shader "T" { uniform token info:id = "UsdUVTexture"; asset inputs:file = @gone.png@; float3 outputs:rgb\n }\n }',
    "USD_COLLISION_FILTER": body("A", inside='def Cube "C" {\n }') + body("B").replace('"PhysicsMassAPI"]', '"PhysicsMassAPI", "PhysicsFilteredPairsAPI"]').replace("float physics:mass", "rel physics:filteredPairs = </A/C>\n float physics:mass"),
    "USD_MIRROR_BAKED": body("B", inside='def Cube "C" { double3 xformOp:scale = (-1, 2, 1)\n uniform token[] xformOpOrder = ["xformOp:scale"]\n }'),
    "USD_SHEAR_BAKED": body("B", inside='def Cube "C" { matrix4d xformOp:transform = ((1,0,0,0),(0.5,1,0,0),(0,0,1,0),(0,0,0,1))\n uniform token[] xformOpOrder = ["xformOp:transform"]\n }'),
}  # fmt: skip


@pytest.mark.parametrize("code", TOLD)
def test_what_is_not_kept_is_told(code, tmp_path):
    scene, report = scene_of(tmp_path, stage(TOLD[code]))
    assert scene is not None, report.diagnostics
    assert codes(report) - {"USD_SUBDIVISION"} == {code} - {"USD_SUBDIVISION"}
    assert code in codes(report)
    (found, *_) = (d for d in report.diagnostics if d.code == code)
    assert found.where.startswith("stage.usda")


@pytest.mark.parametrize("wrong", [
    joint("PhysicsRevoluteJoint", inside='uniform token physics:axis = "z"'),
    joint("PhysicsRevoluteJoint", inside='uniform token drive:angular:physics:type = "speed"\nfloat drive:angular:physics:damping = 3', schemas='"PhysicsDriveAPI:angular"'),
    'def Cylinder "C" {\nuniform token axis = "-Y"\n}\n',
])  # fmt: skip
def test_a_word_that_a_schema_does_not_know_is_no_other_word(tmp_path, wrong):
    scene, report = scene_of(tmp_path, stage(body("B") + wrong))
    assert scene is None and codes(report) == {"USD_VALUE_IMPOSSIBLE"}


def test_what_vendors_state_and_nothing_reads_is_told_once_a_name(tmp_path):
    """Not what stands beside a name that says the same and is read."""
    inside = "int physxRigidBody:lockedPosAxis = 3\nfloat physxRigidBody:linearDamping = 0.5"
    bodies = body("A", inside=inside) + body("B", (1, 0, 0), inside=inside)
    both = joint("PhysicsRevoluteJoint", body0="/A", inside="float newton:armature = 2\ndouble mjc:armature = 2\nfloat state:angular:physics:velocity = 3")  # fmt: skip
    _, report = scene_of(tmp_path, stage(bodies + both))
    told = [o.feature for o in report.outcomes if o.outcome.value == "dropped"]
    assert told == ["physxRigidBody:lockedPosAxis of A and 1 more", "state:angular:physics:velocity of J"]


def test_what_pxr_says_is_told_in_one_order():
    """Its threads compose, and some of what they say comes in another order at each run."""
    from kinefab.sources.usd.stage import tell

    reports = [Report(), Report()]
    for words, report in zip((("b", "a", "b"), ("a", "b")), reports):
        said = [SimpleNamespace(commentary=word) for word in words]
        heard = SimpleNamespace(TakeUncoalescedDiagnostics=said.copy)
        tell(heard, SimpleNamespace(folder=None, name="stage.usda"), report)
    assert len(reports[0].outcomes) == 2 and reports[0].outcomes == reports[1].outcomes


def test_what_pxr_says_is_the_same_wherever_the_stage_lies(tmp_path):
    """Its own words end with an address in memory, and name the folder."""
    said: set[str] = set()
    for folder in (tmp_path / "first", tmp_path / "second"):
        folder.mkdir()
        _, report = scene_of(folder, stage(TOLD["USD_COMPOSITION"]))
        said |= {outcome.message for outcome in report.outcomes if outcome.code == "USD_COMPOSITION"}
    assert len(said) == 1 and "@missing.usda@" in said.pop()


def test_a_layer_in_other_units_is_told(tmp_path):
    (tmp_path / "part.usda").write_text(stage('def Xform "P" { def Sphere "S" {}\n }', metres=0.01), "utf-8")
    scene, report = scene_of(tmp_path, stage(body("B") + 'def Xform "R" (references = @part.usda@</P>) {}'))
    assert scene is not None and codes(report) == {"USD_UNITS_DIFFER"}
    assert scene.source.files[0].uri == "part.usda"


def test_payloads_that_are_left_out_are_told(tmp_path):
    (tmp_path / "part.usda").write_text(stage(body("P")), "utf-8")
    text = stage('def Xform "R" (payload = @part.usda@</P>) {}')
    scene, report = scene_of(tmp_path, text, load="none")
    assert scene is not None and not scene.nodes
    assert codes(report) == {"USD_PAYLOAD_UNLOADED", "USD_WITHOUT_BODIES"}
    assert "/R" in next(d for d in report.diagnostics if d.code == "USD_WITHOUT_BODIES").remedy
    scene, report = scene_of(tmp_path, text)
    assert scene is not None and [node.id for node in scene.nodes] == ["R"]


def test_a_stage_that_multiplies_itself_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("kinefab.sources.usd.walk.MAX_PRIMS", 3)
    scene, report = scene_of(tmp_path, stage("".join(f'def Sphere "S{i}" {{}}\n' for i in range(4))))
    assert scene is None and "USD_TOO_MANY_PRIMS" in codes(report)


def test_the_line_of_a_syntax_error_is_its_place(tmp_path):
    _, report = scene_of(tmp_path, '#usda 1.0\ndef Xform "A" {\n float3 x = oops\n}\n')
    assert report.diagnostics[0].where.startswith("stage.usda:3")


def test_no_mutation_of_a_stage_is_a_traceback(tmp_path, fuzz_count):
    """Every one is read or refused by diagnostics; ``--fuzz N`` tries N of them, a run without it a few."""
    count = fuzz_count if fuzz_count >= 1000 else fuzz_count // 4
    script = Path(__file__).with_name("usd_mutations.py")
    done = subprocess.run(
        [sys.executable, str(script), str(tmp_path), str(count), "14"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr[-2000:]
    accepted, refused = map(int, done.stdout.split())
    assert accepted + refused == count and min(accepted, refused) > 0


def test_a_pair_that_is_filtered_from_both_sides_is_one(tmp_path):
    pair = body("A") + body("B", (1, 0, 0))
    pair = pair.replace('"PhysicsMassAPI"]', '"PhysicsMassAPI", "PhysicsFilteredPairsAPI"]')
    text = stage(
        pair.replace("float physics:mass", "rel physics:filteredPairs = [</A>, </B>]\n float physics:mass")
    )
    scene, _ = scene_of(tmp_path, text)
    (pair,) = scene.apart
    assert [scene.nodes[pair.a].id, scene.nodes[pair.b].id] == ["A", "B"]


@pytest.mark.parametrize("kind", ["PhysicsFixedJoint", "PhysicsSphericalJoint", "PhysicsDistanceJoint"])
def test_a_drive_or_range_of_a_joint_that_has_no_such_freedom_is_told(tmp_path, kind):
    applied = '"PhysicsDriveAPI:rotX", "PhysicsLimitAPI:transZ"'
    inside = "float drive:rotX:physics:stiffness = 5\nfloat limit:transZ:physics:high = 1\n"
    text = stage(body("A") + body("B") + joint(kind, "J", inside, "/A", "/B", applied))
    _, report = scene_of(tmp_path, text)
    told = {o.feature for o in report.outcomes if o.outcome.value == "dropped"}
    assert told == {"PhysicsDriveAPI:rotX of J", "PhysicsLimitAPI:transZ of J"}


def test_a_collider_of_several_groups_is_in_the_first_and_the_others_are_told(tmp_path):
    cube = 'def Cube "C" (prepend apiSchemas = ["PhysicsCollisionAPI"]) {}\n'
    text = body("A", inside=cube) + body("B", at=(9, 0, 0), inside=cube)
    for name, members in (("G1", "</A>"), ("G2", "[</A>, </B>]")):
        text += f'def PhysicsCollisionGroup "{name}" (prepend apiSchemas = ["CollectionAPI:colliders"]) {{\nrel collection:colliders:includes = {members}\n}}\n'
    scene, report = scene_of(tmp_path, stage(text))
    assert [c.group for node in scene.nodes for c in node.colliders] == ["G1", "G2"]
    (told,) = [o for o in report.outcomes if o.code == "USD_FEATURE_APPROXIMATED"]
    assert told.feature == "collision group of A/C"


@pytest.mark.parametrize(
    ("schema", "stated"),
    [("PhysxDeformableBodyAPI", ""), ("PhysxParticleClothAPI", ""), ("OmniPhysicsDeformableBodyAPI", "float omniphysics:mass = 3")],
)  # fmt: skip
def test_what_is_soft_stands_still_and_is_told(tmp_path, schema, stated):
    """Of the mesh itself, and of a group above it, as the younger schemas have it."""
    for above in ("", f'def Xform "X" (prepend apiSchemas = ["{schema}"]) {{\n{stated}\n'):
        applied = "" if above else f'(prepend apiSchemas = ["{schema}"])'
        text = f'{above}def Mesh "M" {applied} {{\n{MESH}\n{"" if above else stated}\n}}\n{"}" if above else ""}\n'
        scene, report = scene_of(tmp_path, stage(body("B") + text), f"{schema}{len(above)}.usda")
        told = {o.feature for o in report.outcomes if o.outcome.value == "dropped"}
        path = "X" if above else "M"
        assert told == {f"{schema} of /{path}"} | ({f"omniphysics:mass of {path}"} if stated else set())


@pytest.mark.parametrize(
    ("content", "feature"),
    [
        ('def XForm "A" {\n}\ndef XForm "C" {\n}\n', "XForm /A and 1 more"),
        ('def OmniGraph "A" {\n}\n', "OmniGraph /A"),
        ('def Skeleton "A" {\n}\n', "Skeleton /A"),
        ('def SpatialAudio "A" {\n}\n', "SpatialAudio /A"),
        ('def Cube "A" (prepend apiSchemas = ["MeshLightAPI"]) {\n}\n', "light /A"),
        ('def Xform "A" {\n}\ndef Scope "C" {\n}\ndef SkelRoot "D" {\n}\ndef "E" {\n}\n', ""),
    ],
)
def test_types_that_nothing_is_read_of_are_told_once_each(tmp_path, content, feature):
    """A type that is misspelt has no place to stand: what lies below it stands at its origin, as in usdview."""
    scene, report = scene_of(tmp_path, stage(body("B") + content))
    assert scene is not None
    assert [o.feature for o in report.outcomes if o.outcome.value == "dropped"] == [feature] * bool(feature)


@pytest.mark.parametrize(
    ("material", "code"), [("", "USD_TARGET_MISSING"), ('def Scope "M" {\n}\n', "USD_FEATURE_DROPPED")]
)
def test_a_material_that_is_not_there_is_told_once_where_it_is_named(tmp_path, material, code):
    meshes = "".join(
        f'def Mesh "{name}" {{\n{MESH}\nuniform token subdivisionScheme = "none"\n}}\n' for name in "PQ"
    )
    inside = f'def Xform "X" (prepend apiSchemas = ["MaterialBindingAPI"]) {{\nrel material:binding = </M>\n{meshes}}}\n'
    _, report = scene_of(tmp_path, stage(body("B", inside=inside) + material))
    (found,) = [o for o in report.outcomes if o.outcome.value == "dropped"]
    assert (found.feature, found.code) == ("material of /B/X", code) and "/M" in report.diagnostics[
        -1
    ].message


@pytest.mark.parametrize("schema", ["Preliminary_PhysicsRigidBodyAPI", "Preliminary_PhysicsColliderAPI"])
def test_physics_of_arkit_are_told_by_name(tmp_path, schema):
    text = f'def Cube "Box" (prepend apiSchemas = ["{schema}"]) {{ double preliminary:physics:rigidBody:mass = 3\n }}'
    _, report = scene_of(tmp_path, stage(text))
    (told,) = [o for o in report.outcomes if schema in o.feature]
    assert told.outcome.value == "dropped" and "/Box" in told.feature
