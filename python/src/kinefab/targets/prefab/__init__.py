"""``NAME.prefab`` and the folder ``NAME`` beside it: Unity's own files, which need no plug-in.

``text`` knows how Unity writes, ``objects`` the GameObjects and components, ``assets`` what they refer to; ``exporting`` makes
the files of a scene, ``folder`` puts them in place.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from ...diagnostics import KinefabError, is_encodable
from ...replacing import one_at_a_time
from ..content import Content
from .exporting import prefab_files, script_files, script_folder
from .folder import own_guids, put_in_place
from .last import last_prefab
from .layers import layers_and_tags
from .names import UNSEEN, why_not_shared
from .options import PrefabOptions
from .project import common_folder, elsewhere_in_project, has_script, identity_of, lends_script, project_of

ENDING = ".prefab"


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the prefab and its folder; returns the prefab, then every file but the ``.meta``.

    Raises KinefabError where a file of somebody else's is in the way, OSError as the file system does; then the old files
    stand as they were.
    """
    report = content.report
    options = PrefabOptions.of(content.options)
    if not is_encodable(target.name):
        detail = "its name is not UTF-8"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    name = target.name[: -len(ENDING)]
    if UNSEEN.fullmatch(name):
        detail = f"Unity imports no assets, or not for every build, from a folder '{name}', which is its folder's name"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    if detail := why_not_shared(name):
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    target = target.with_name(f"{name}{ENDING}")  # in Unity's own writing, whatever capitals were asked for
    content.unity(links=options.articulation)  # what takes longest, before others have to wait
    with one_at_a_time(common_folder(target)):
        return _write(content, target, name, options)


def _write(content: Content, target: Path, name: str, options: PrefabOptions) -> tuple[Path, ...]:
    """While nobody else writes into the project: what is there decides about guids and the script."""
    home = f"{name}/Scripts"
    elsewhere = elsewhere_in_project(target)
    identity, lent = identity_of(target, elsewhere), lends_script(target, elsewhere, home)
    scripts = None if options.scripts and has_script(elsewhere) else home
    last, words = last_prefab(target, partial(own_guids, target)), layers_and_tags(project_of(target))
    files = prefab_files(content, name, options, scripts, identity, last, words)
    if lent and not any(file.path == home for file in files):
        files += [script_folder(home), *script_files(home)]
    content.refuse_losses()
    return put_in_place(files, target, identity, content.report, content.progress)
