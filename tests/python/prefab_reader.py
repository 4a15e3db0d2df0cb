"""Reads a prefab and its assets back, by the files alone: a tree of objects in the words of the scene file.

Knows nothing of the writer; numbers of enumerations are Unity's own, from its scripting reference.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from unity_yaml import Document, documents, mapping

MOTION = ("Locked", "Limited", "Free")
BUILT_IN = (
    "0000000000000000f000000000000000",
    "933532a4fcc9baf4fa0491de14d08ed7",
    "6e4ae4064600d784cac1e41a9e6f2e59",
    "d0353a89b1f911e48b9e16bdc9f2e058",
)
"""Files of Unity itself and of its packages that ours refer to: shaders, and URP's script of a material's version."""


@dataclass
class Node:
    name: str
    active: bool
    transform: dict
    components: list[dict]
    children: list[Node] = field(default_factory=list)
    file_id: int = 0


class Project:
    """The files below a folder, by their guids."""

    def __init__(self, folder: Path):
        self.paths: dict[str, Path] = {}
        for meta in sorted(folder.rglob("*.meta")):
            guid = str(mapping(meta.read_text("utf-8"))["guid"])
            assert guid not in self.paths, f"{meta} and {self.paths[guid]} have one guid"
            self.paths[guid] = meta.with_suffix("")
            assert self.paths[guid].exists(), f"{meta} stands alone"

    def asset(self, reference: dict) -> Document | None:
        """The object that a reference means, None for none; the file must be there and hold it."""
        if reference["fileID"] == "0":
            return None
        assert reference["type"] == "2"
        found = documents(self.paths[reference["guid"]].read_text("utf-8"))
        (own,) = [d for d in found if str(d.file_id) == reference["fileID"]]
        return own


def vector(value: dict) -> list[float]:
    return [float(np.float32(value[k])) for k in ("xyzw" if "x" in value else "rgba") if k in value]


def real(value: str) -> float:
    return float(np.float32(value))


def read_prefab(path: Path) -> tuple[Node, Project]:
    """The root, and what the prefab refers to."""
    project = Project(path.parent)
    found = {str(d.file_id): d for d in documents(path.read_text("utf-8"))}
    (root,) = [d for d in found.values() if d.kind == "Transform" and d.fields["m_Father"]["fileID"] == "0"]
    return _node(root, found, project), project


def _node(transform: Document, found: dict[str, Document], project: Project) -> Node:
    owner = found[transform.fields["m_GameObject"]["fileID"]]
    held = [found[c["component"]["fileID"]] for c in owner.fields["m_Component"]]
    assert held[0] is transform and all(
        c.fields["m_GameObject"]["fileID"] == str(owner.file_id) for c in held
    )
    placed = {
        "localPosition": vector(transform.fields["m_LocalPosition"]),
        "localRotation": vector(transform.fields["m_LocalRotation"]),
        "localScale": vector(transform.fields["m_LocalScale"]),
    }
    components = [_component(c, found, project) for c in held[1:]]
    node = Node(
        str(owner.fields["m_Name"]),
        owner.fields["m_IsActive"] == "1",
        placed,
        components,
        file_id=owner.file_id,
    )
    for child in transform.fields["m_Children"]:
        below = found[child["fileID"]]
        assert below.fields["m_Father"]["fileID"] == str(transform.file_id)
        node.children.append(_node(below, found, project))
    return node


def _flag(text: str) -> bool:
    assert text in ("0", "1")
    return text == "1"


def _body(reference: dict, found: dict[str, Document], kind: str = "Rigidbody") -> int | None:
    """The fileID of the GameObject that has the body."""
    if reference["fileID"] == "0":
        return None
    assert found[reference["fileID"]].kind == kind
    return int(found[reference["fileID"]].fields["m_GameObject"]["fileID"])


def _component(document: Document, found: dict[str, Document], project: Project) -> dict:
    f = document.fields
    kind = {"type": document.kind, "fileID": document.file_id}
    if document.kind == "MeshFilter":
        return kind | {"mesh": read_mesh(project.asset(f["m_Mesh"]))}
    if document.kind == "MeshRenderer":
        materials = [project.asset(m) for m in f["m_Materials"]]
        return kind | {"enabled": _flag(f["m_Enabled"]), "materials": materials}
    if document.kind == "Rigidbody":
        return kind | _rigidbody(f)
    if document.kind.endswith("Collider"):
        return kind | _collider(document.kind, f, project)
    if document.kind.endswith("Joint"):
        return kind | _joint(document.kind, f, found)
    return kind | {"fields": f}


def _rigidbody(f: dict) -> dict:
    told = {
        "mass": real(f["m_Mass"]),
        "linearDamping": real(f["m_Drag"]),
        "angularDamping": real(f["m_AngularDrag"]),
        "useGravity": _flag(f["m_UseGravity"]),
        "isKinematic": _flag(f["m_IsKinematic"]),
        "interpolation": ("None", "Interpolate", "Extrapolate")[int(f["m_Interpolate"])],
        "collisionDetectionMode": ("Discrete", "Continuous", "ContinuousDynamic", "ContinuousSpeculative")[
            int(f["m_CollisionDetection"])
        ],
    }
    if "m_CenterOfMass" in f:
        assert f["m_ImplicitCom"] == f["m_ImplicitTensor"] == "0"
        told |= {
            "centerOfMass": vector(f["m_CenterOfMass"]),
            "inertiaTensor": vector(f["m_InertiaTensor"]),
            "inertiaTensorRotation": vector(f["m_InertiaRotation"]),
        }
    return told


def _collider(kind: str, f: dict, project: Project) -> dict:
    told: dict = {"isTrigger": _flag(f["m_IsTrigger"]), "enabled": _flag(f["m_Enabled"])}
    told["material"] = project.asset(f["m_Material"])
    if kind == "MeshCollider":
        return told | {"convex": _flag(f["m_Convex"]), "mesh": read_mesh(project.asset(f["m_Mesh"]))}
    told["center"] = vector(f["m_Center"])
    if kind == "BoxCollider":
        return told | {"size": vector(f["m_Size"])}
    told["radius"] = real(f["m_Radius"])
    if kind == "CapsuleCollider":
        told |= {"height": real(f["m_Height"]), "direction": "XYZ"[int(f["m_Direction"])]}
    return told


def _joint(kind: str, f: dict, found: dict[str, Document]) -> dict:
    told: dict = {
        "connectedBody": _body(f["m_ConnectedBody"], found),
        "breakForce": float(f["m_BreakForce"].replace("Infinity", "inf")),
        "breakTorque": float(f["m_BreakTorque"].replace("Infinity", "inf")),
        "enableCollision": _flag(f["m_EnableCollision"]),
        "enablePreprocessing": _flag(f["m_EnablePreprocessing"]),
        "massScale": real(f["m_MassScale"]),
        "connectedMassScale": real(f["m_ConnectedMassScale"]),
    }
    if f["m_ConnectedArticulationBody"]["fileID"] != "0":
        told["connectedArticulationBody"] = _body(f["m_ConnectedArticulationBody"], found, "ArticulationBody")
    if kind == "FixedJoint":
        return told
    told |= {
        name: vector(f[f"m_{name[0].upper()}{name[1:]}"]) for name in ("anchor", "axis", "connectedAnchor")
    }
    told["autoConfigureConnectedAnchor"] = _flag(f["m_AutoConfigureConnectedAnchor"])
    if kind == "HingeJoint":
        for name in ("useSpring", "useMotor", "useLimits", "extendedLimits", "useAcceleration"):
            if f"m_{name[0].upper()}{name[1:]}" in f:
                told[name] = _flag(f[f"m_{name[0].upper()}{name[1:]}"])
        for name in ("spring", "motor", "limits"):
            told[name] = {k: real(v) for k, v in f[f"m_{name.title()}"].items()}
        told["motor"]["freeSpin"] = bool(told["motor"]["freeSpin"])
        return told
    for key, value in f.items():
        name = key[2].lower() + key[3:]
        if name.endswith("Motion"):
            told[name] = MOTION[int(value)]
        elif name.endswith(("Limit", "Spring")) and isinstance(value, dict):
            told[name] = {k: real(v) for k, v in value.items()}
        elif name.endswith("Drive") and isinstance(value, dict):
            told[name] = {k: real(v) for k, v in value.items() if k != "serializedVersion"}
            told[name]["useAcceleration"] = bool(told[name].get("useAcceleration", 0.0))
            if told[name]["maximumForce"] >= real("3.4028233e+38"):
                told[name]["maximumForce"] = float("inf")
        elif name.startswith("target") or name == "secondaryAxis":
            told[name] = vector(value)
    told |= {
        "rotationDriveMode": ("XYAndZ", "Slerp")[int(f["m_RotationDriveMode"])],
        "projectionMode": ("None", "PositionAndRotation")[int(f["m_ProjectionMode"])],
        "projectionDistance": real(f["m_ProjectionDistance"]),
        "projectionAngle": real(f["m_ProjectionAngle"]),
        "configuredInWorldSpace": _flag(f["m_ConfiguredInWorldSpace"]),
        "swapBodies": _flag(f["m_SwapBodies"]),
    }
    return told


_SIZES = {0: ("<f4", 4)}


def read_mesh(document: Document | None) -> dict | None:
    """Every channel by its index, the triangles of each submesh; the sizes it states are held against what is there."""
    if document is None:
        return None
    f = document.fields
    short = f["m_IndexFormat"] == "0"
    indices = np.frombuffer(bytes.fromhex(f["m_IndexBuffer"]), "<u2" if short else "<u4").astype(np.int64)
    data = f["m_VertexData"]
    count, raw = int(data["m_VertexCount"]), bytes.fromhex(data["_typelessdata"])
    assert int(data["m_DataSize"]) == len(raw) and len(data["m_Channels"]) == 14
    used = [(i, c) for i, c in enumerate(data["m_Channels"]) if c["dimension"] != "0"]
    streams: dict[int, list] = {}
    for i, c in used:
        kind, size = _SIZES[int(c["format"])]
        streams.setdefault(int(c["stream"]), []).append(
            (i, int(c["offset"]), int(c["dimension"]), kind, size)
        )
    channels, start = {}, 0
    for number in sorted(streams):
        stride = sum(dimension * size for _, _, dimension, _, size in streams[number])
        block = np.frombuffer(raw, np.uint8, stride * count, start).reshape(count, stride)
        for i, offset, dimension, kind, size in streams[number]:
            channels[i] = np.ascontiguousarray(block[:, offset : offset + dimension * size]).view(kind)
        start += -(-stride * count // 16) * 16
    submeshes, bounds = [], []
    for s in f["m_SubMeshes"]:
        assert s["topology"] == "0" and s["baseVertex"] == "0"
        first = int(s["firstByte"]) // (2 if short else 4)
        own = indices[first : first + int(s["indexCount"])]
        assert len(own) == int(s["indexCount"]) and len(own) % 3 == 0
        if len(own):
            assert own.min() >= int(s["firstVertex"])
            assert own.max() < int(s["firstVertex"]) + int(s["vertexCount"])
        submeshes.append(own.reshape(-1, 3))
        bounds.append((vector(s["localAABB"]["m_Center"]), vector(s["localAABB"]["m_Extent"])))
    box = (vector(f["m_LocalAABB"]["m_Center"]), vector(f["m_LocalAABB"]["m_Extent"]))
    return {
        "name": str(f["m_Name"]),
        "channels": channels,
        "submeshes": submeshes,
        "bounds": box,
        "parts": bounds,
        "short": short,
    }
