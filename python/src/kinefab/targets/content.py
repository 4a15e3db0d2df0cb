"""What a target is given to write."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..diagnostics import KinefabError, Outcome, Report, Severity
from ..findings import JointFinding
from ..geometry.looks.shading import with_normals
from ..model import Scene
from ..options import DEFAULT_SMOOTH, ColliderShape
from ..rigid import RigidGroups
from ..unity.scene import UnityScene


@dataclass(slots=True, eq=False)
class Content:
    """An analysed scene.

    scene: right-handed, with the joints that were found (see ``Analysis.scene``).  groups: its rigid groups.
    findings: what the analysis found of the joints, by their ids.
    mapped: the scene in Unity's terms; ``unity`` makes it when a target asks, and the report tells its losses then.  Asked whether
    joints make links of the bodies that they join.
    report: gets what the target cannot say.  options: values by the names of the target's ``options``.
    colliders: shape asked for where a part states no colliders.  smooth: see ``with_normals``.
    strict: whether a loss that is worth a warning is an error.  progress: how much is written, 0 to 1.
    """

    scene: Scene
    groups: RigidGroups
    findings: Mapping[str, JointFinding]
    mapped: Callable[[bool], UnityScene]
    report: Report
    options: Mapping[str, Any] = field(default_factory=dict[str, Any])
    strict: bool = False
    progress: Callable[[float], None] = lambda fraction: None
    colliders: ColliderShape = ColliderShape.AUTO
    smooth: float | None = DEFAULT_SMOOTH
    _unity: UnityScene | None = None

    def drawn(self) -> Scene:
        """The scene with normals on what is drawn.  What touches is made of ``scene``, whose vertices are fewer."""
        return with_normals(self.scene, self.smooth)

    def unity(self, links: bool = False) -> UnityScene:
        """In Unity's terms, mapped once.  links: see ``mapped``, for a target that asks first."""
        if self._unity is None:
            self._unity = self.mapped(links)
        return self._unity

    @property
    def in_unity(self) -> UnityScene | None:
        """The scene in Unity's terms, where the target asked for it."""
        return self._unity

    def refuse_losses(self) -> None:
        """Raise KinefabError for errors; if strict, also for every loss that is worth a warning.  A target calls it when
        it has told what it cannot say, before it writes."""
        errors = self.report.of(Severity.ERROR)
        if self.strict:
            lossy = {o.code for o in self.report.outcomes if o.outcome is not Outcome.KEPT}
            errors += [d for d in self.report.of(Severity.WARNING) if d.code in lossy]
        if errors:
            raise KinefabError(errors)
