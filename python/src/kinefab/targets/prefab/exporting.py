"""From a scene in Unity's terms to the files of a prefab."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import islice

from ...unity.assets.meshes import mesh_name
from ...unity.links.tree import articulated
from ...unity.scene import (
    AnimationClip,
    ArticulationBody,
    Component,
    Rigidbody,
    UnityScene,
)
from ...unity.switched_off import without_switched_off
from ..content import Content
from ..tangents import normal_mapped, with_tangents
from .assets.clips import CLIP_ID, clip_asset
from .assets.identities import mesh_identities, named_identities
from .assets.materials import MATERIAL_ID, material_asset
from .assets.meshes import MESH_ID, mesh_asset
from .assets.physics_materials import PHYSICS_MATERIAL_ENDING, PHYSICS_MATERIAL_ID, physics_material_asset
from .assets.textures import TextureFile, Textures, reference, shown, twins_of
from .files import AssetFile
from .last import GUID, NOTHING, LastExport
from .layers import LayersAndTags
from .losses import TARGET, empty_colliders, tell_couplings, tell_losses, tell_names
from .meshes import mesh_origin
from .names import file_name, folded, most_bytes, unique
from .objects.couplings import ASSEMBLY, FOLDER, SCRIPT, is_kept_by_script, script_guid
from .objects.hierarchy import Hierarchy, References
from .objects.matching import assets_of_before
from .options import PrefabOptions
from .text.dialects import Pipeline
from .text.ids import guid
from .text.metas import assembly_meta, folder_meta, native_meta, prefab_meta, script_meta
from .text.yaml import HEADER, Plain, external

NATIVE = 2
"""The type of a reference to an asset in Unity's own YAML."""
TOGETHER = 1024
"""Documents of one piece of the prefab: about a megabyte."""
MESHES, MATERIALS, TEXTURES, PHYSICS, ANIMATIONS = (
    "Meshes",
    "Materials",
    "Textures",
    "Physics Materials",
    "Animations",
)


def prefab_files(
    content: Content,
    name: str,
    options: PrefabOptions,
    scripts_folder: str | None,
    identity: str = "",
    last: LastExport = NOTHING,
    words: LayersAndTags = LayersAndTags(),
) -> list[AssetFile]:
    """Everything of the export, the prefab first, folders before what they hold.

    name: of the prefab, without ending.  scripts_folder: where a script goes, None where the project has it already.  identity: by what
    guids are told from other exports', "" for the name.  last: what this export takes the place of, whose numbers stay with what is
    still there.  words: layers and tags of the project.  The report gets what a prefab cannot say.
    """
    return _Export(content, name, options, scripts_folder, identity, words).files(last)


class _Export:
    """Collects the files; ``folder`` is the one beside the prefab."""

    def __init__(
        self,
        content: Content,
        name: str,
        options: PrefabOptions,
        scripts_folder: str | None,
        identity: str,
        words: LayersAndTags,
    ):
        self.scripts_folder, self.identity, self.words = scripts_folder, identity or name, words
        self.content, self.name, self.options = content, name, options
        self.scene = without_switched_off(content.unity(links=options.articulation), TARGET, content.report)
        if options.articulation:
            self.scene = articulated(self.scene, content.scene, content.groups, content.report)
        self.dialect = options.dialect
        self.found: list[AssetFile] = []

    def files(self, last: LastExport) -> list[AssetFile]:
        scene, report = self.scene, self.content.report
        tell_losses(scene, self.options, report)
        self.words.tell(scene, report)
        kept = [c for c in scene.couplings if self.options.scripts and is_kept_by_script(c, scene)]
        tell_couplings([c for c in scene.couplings if c not in kept], report)
        left_out, identities = empty_colliders(scene, report), self.content.scene.identities
        hierarchy = Hierarchy(scene, self.name, self.dialect, left_out, identities, self.words)
        tell_names(scene, hierarchy.scene_names, report)
        references = References(
            self._meshes(), self._materials(), self._physics_materials(), self._clips(hierarchy)
        )
        if last:
            references = self._know_again(last, hierarchy, references)
        hierarchy.add_components(references)
        if references.clips:
            hierarchy.add_clips(references.clips, plays=not _moved_by_forces(scene))
        if kept:
            hierarchy.add_couplings(kept)
            if self.scripts_folder is not None:
                self.found += script_files(self.scripts_folder)
        folders = sorted({file.path.rpartition("/")[0] for file in self.found} | {self.name})
        head = [
            AssetFile(
                f"{self.name}.prefab",
                self._guid("prefab"),
                prefab_meta(self._guid("prefab")),
                partial(_prefab, hierarchy),
            )
        ]
        for folder in folders:
            if folder == self.scripts_folder:
                head.append(script_folder(folder))
            else:
                own = self._guid("folder", self.identity + folder[len(self.name) :])
                head.append(AssetFile(folder, own, folder_meta(own)))
        return head + self.found

    def _know_again(self, last: LastExport, hierarchy: Hierarchy, references: References) -> References:
        """Numbers and guids of what the last export had too."""
        report, found = self.content.report, hierarchy.know_again(last, self.content.scene.counted, references)
        for id in dict.fromkeys(found.unsure):
            report.approximated(f"identity of {id}", "TARGET_IDENTITY_UNSURE", object=id)
        now = frozenset(file.guid for file in self.found)
        renamed = assets_of_before(hierarchy.pairs(found), last, now)
        if not renamed:
            return references
        self.found = [
            replace(file, guid=old, meta=file.meta.replace(file.guid, old)) if (old := renamed.get(file.guid)) else file
            for file in self.found
        ]

        def again(plain: Plain) -> Plain:
            return Plain(GUID.sub(lambda match: f"guid: {renamed.get(match[1], match[1])}", plain))

        return References(
            {i: again(r) for i, r in references.meshes.items()},
            {i: again(r) for i, r in references.materials.items()},
            {i: again(r) for i, r in references.physics_materials.items()},
            [again(r) for r in references.clips],
        )

    def _guid(self, *identity: str) -> str:
        return guid(self.identity, *identity)

    def _file_name(self, name: str) -> str:
        return file_name(name, most_bytes(self.name))

    def _assets(
        self,
        folder: str,
        ending: str,
        main: int,
        identities: Sequence[str],
        names: Sequence[str],
        made: Callable[[int, str], Iterable[bytes]],
    ) -> list[Plain]:
        """Files of one kind in a folder of their own, and the references to them.  made: content by index and name."""
        plain = unique([(self._file_name(n), i) for n, i in zip(names, identities)], folded)
        references: list[Plain] = []
        for k, (identity, title) in enumerate(zip(identities, plain)):
            own = self._guid(folder, identity)
            path = f"{self.name}/{folder}/{title}{ending}"
            self.found.append(AssetFile(path, own, native_meta(own, main), partial(made, k, title)))
            references.append(external(main, own, NATIVE))
        return references

    def _meshes(self) -> dict[int, Plain]:
        meshes = self.scene.meshes
        identities = mesh_identities(self.scene, self.content.scene, partial(mesh_origin, meshes))
        used = sorted(identities)
        names = [mesh_name(meshes, i) for i in used]

        bumpy = normal_mapped(self.scene)

        def made(k: int, title: str) -> Iterator[bytes]:
            mesh = meshes[used[k]]
            return mesh_asset(with_tangents(mesh) if used[k] in bumpy else mesh, title)

        references = self._assets(MESHES, ".asset", MESH_ID, [identities[i] for i in used], names, made)
        return dict(zip(used, references))

    def _materials(self) -> dict[int, Plain]:
        materials, options = self.scene.materials, self.options
        shader, identities = f"the {options.pipeline.value} shader", named_identities(materials)
        textures = Textures(
            self.content.report, shader, twins_of(materials), own_emission=options.pipeline is Pipeline.HDRP
        )
        slots = [textures.wanted(*each) for each in zip(materials, identities)]
        references = self._textures(list(textures.files.values()))
        maps = [shown(s, references, m) for s, m in zip(slots, materials)]

        def made(k: int, title: str) -> list[bytes]:
            return [material_asset(materials[k], title, maps[k], options.pipeline, self.dialect)]

        names = [material.name for material in materials]
        found = self._assets(MATERIALS, ".mat", MATERIAL_ID, identities, names, made)
        return dict(enumerate(found))

    def _textures(self, files: Sequence[TextureFile]) -> dict[str, Plain]:
        """References by the identities of the files."""
        plain = unique([(self._file_name(f.name), f.identity) for f in files], folded)
        found: dict[str, Plain] = {}
        for file, title in zip(files, plain):
            own = self._guid(TEXTURES, file.identity)
            path = f"{self.name}/{TEXTURES}/{title}{file.ending}"
            self.found.append(AssetFile(path, own, file.meta(own), file.content))
            found[file.identity] = reference(own)
        return found

    def _physics_materials(self) -> dict[int, Plain]:
        materials = self.scene.physicsMaterials

        def made(k: int, title: str) -> list[bytes]:
            return [physics_material_asset(materials[k], title, self.dialect)]

        names = [material.name or "Physics Material" for material in materials]
        references = self._assets(
            PHYSICS, PHYSICS_MATERIAL_ENDING, PHYSICS_MATERIAL_ID, named_identities(materials), names, made
        )
        return dict(enumerate(references))

    def _clips(self, hierarchy: Hierarchy) -> list[Plain]:
        clips = self.scene.animations

        def made(k: int, title: str) -> list[bytes]:
            paths = {track.gameObject: hierarchy.path(track.gameObject) for track in clips[k].tracks}
            return [clip_asset(clips[k], title, paths, self.dialect)]

        names = [clip.name for clip in clips]
        return self._assets(ANIMATIONS, ".anim", CLIP_ID, named_identities(clips), names, made)


def script_folder(folder: str) -> AssetFile:
    """What ``script_files`` stand in."""
    own = guid("", "folder", folder)
    return AssetFile(folder, own, folder_meta(own))


def script_files(folder: str) -> list[AssetFile]:
    """The script and its assembly, the same in every export."""
    metas = {SCRIPT: script_meta(script_guid(SCRIPT)), ASSEMBLY: assembly_meta(script_guid(ASSEMBLY))}
    return [
        AssetFile(f"{folder}/{name}", script_guid(name), meta, partial(_bytes_of, name))
        for name, meta in metas.items()
    ]


def _bytes_of(name: str) -> list[bytes]:
    return [(FOLDER / name).read_bytes()]


def _prefab(hierarchy: Hierarchy) -> Iterator[bytes]:
    yield HEADER.encode()
    documents = hierarchy.documents()
    while together := list(islice(documents, TOGETHER)):
        yield "".join(together).encode("ascii")



def _moved_by_forces(scene: UnityScene) -> bool:
    """Whether a clip moves what the solver moves too: then the user chooses which of them does."""

    def physical(clip: AnimationClip) -> bool:
        for track in clip.tracks:
            at: int | None = track.gameObject
            while at is not None:
                entry = scene.gameObjects[at]
                if any(_is_moved(component) for component in entry.components):
                    return True
                at = entry.parent
        return False

    return any(physical(clip) for clip in scene.animations)


def _is_moved(component: Component) -> bool:
    if isinstance(component, ArticulationBody):
        return not component.immovable
    return isinstance(component, Rigidbody) and not component.isKinematic
