"""The shortest road from a CAD program's own file to one that is read, for the remedy of an ending that is not known.

Each stands at length in ``python/README.md``, "From my CAD program".
"""

from __future__ import annotations

import re

STEP_ROAD = "export STEP (AP242, else AP214) and run: kinefab mates NAME.step, then kinefab export NAME.step --mates auto"
MESH_ROAD = (
    "put one file a part into a folder (OBJ, STL or GLB) and run: kinefab bundle init FOLDER --units mm"
)

INVENTOR = (
    f"Inventor: open the assembly and run: kinefab capture inventor -o NAME.bundle.json; or {STEP_ROAD}."
)
SOLIDWORKS = (
    f"SolidWorks: open the assembly and run: kinefab capture solidworks -o NAME.bundle.json; or {STEP_ROAD}."
)
FUSION = f"Fusion: install the add-in that kinefab capture fusion --help tells of, open the design; or {STEP_ROAD}."
CREO_ROAD = "Creo with Simscape Multibody Link (free; needs MATLAB) writes NAME.xml, joints and all: kinefab export NAME.xml"
NX_OR_CREO = f"NX, Creo or Solid Edge: {STEP_ROAD}. {CREO_ROAD}."
CATIA = f"CATIA: {STEP_ROAD}."
MESH_ONLY = f"It holds no joints that can be read: {MESH_ROAD}."

JSON = (
    "This JSON is none that is read: a CAD bundle (meta, components), an assembly of the Fusion 360 Gallery (tree, occurrences), "
    "an assembly definition of Onshape (rootAssembly; give definition.json, features.json and matevalues.json beside it count too)."
)
XML = "This XML is none that is read: its root is neither mujoco (MJCF) nor SimscapeMultibodyImportXML (Simscape Multibody 2.0)."

UNITY = "Unity's own file, which is written and not read: give the source, or the .kinefab, that it was made of."

ROADS = {
    **dict.fromkeys((".prefab", ".unitypackage", ".unity"), UNITY),
    ".json": JSON,
    ".xml": XML,
    **dict.fromkeys((".iam", ".ipt", ".idw", ".ipn"), INVENTOR),
    **dict.fromkeys((".sldasm", ".sldprt", ".slddrw"), SOLIDWORKS),
    **dict.fromkeys((".f3d", ".f3z"), FUSION),
    ".asm": f"Creo or Solid Edge: {STEP_ROAD}. {CREO_ROAD}.",
    **dict.fromkeys((".prt", ".par", ".psm"), NX_OR_CREO),
    **dict.fromkeys((".catproduct", ".catpart", ".cgr", ".model", ".exp", ".session"), CATIA),
    **dict.fromkeys((".smt", ".smb"), f"The kernel's own file of Inventor or Fusion; there: {STEP_ROAD}."),
    **dict.fromkeys((".fcstd1", ".fcbak"), "A copy that FreeCAD keeps: give it the ending .FCStd."),
    **dict.fromkeys((".stpz", ".gz", ".zip", ".7z", ".rar"), "Packed: unpack it, and give the file inside."),
    **dict.fromkeys((".stpx", ".stpxz"), f"AP242 as XML; export it as Part 21 (.step) instead: {STEP_ROAD}."),
    **dict.fromkeys((".ifc", ".rvt"), f"A building; of its parts: {MESH_ROAD}."),
    **dict.fromkeys(
        (".jt", ".x_t", ".x_b", ".xmt_txt", ".sat", ".sab", ".neu", ".wire", ".vda"),
        f"Open it in a CAD program: {STEP_ROAD}.",
    ),
    ".3dxml": f"CATIA or 3DEXPERIENCE: {STEP_ROAD}.",
    ".3dm": f"Rhino: {STEP_ROAD}; or {MESH_ROAD}.",
    ".skp": f"SketchUp: {MESH_ROAD}.",
    **dict.fromkeys((".dwg", ".dxf"), f"AutoCAD: {STEP_ROAD}."),
    ".blend": f"Blender: {MESH_ROAD}.",
    **dict.fromkeys((".max", ".mb", ".ma", ".c4d"), f"Export OBJ, STL or GLB: {MESH_ROAD}."),
    **dict.fromkeys(
        (
            ".obj",
            ".stl",
            ".ply",
            ".glb",
            ".gltf",
            ".dae",
            ".3mf",
            ".off",
            ".fbx",
            ".3ds",
            ".wrl",
            ".vrml",
            ".x3d",
        ),
        MESH_ONLY,
    ),
}
"""By ending, lower case."""


def road_of(name: str) -> str:
    """The sentence for a file's name; "" where nothing better is known than the list of what is read.

    Creo numbers its versions behind the ending (``arm.asm.7``).
    """
    match = re.search(r"(\.\w+?)(?:\.\d+)?$", name.lower())
    return ROADS.get(match[1], "") if match else ""
