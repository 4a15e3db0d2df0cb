"""Animation clips."""

from __future__ import annotations

from collections.abc import Sequence

from .findings import Entry, Findings


def check_animations(clips: Sequence[Entry], objects: int, found: Findings) -> None:
    for index, clip in enumerate(clips):
        times: Sequence[float] = clip["times"]
        still = next((i for i in range(1, len(times)) if not times[i] > times[i - 1]), None)
        if still is not None:
            found.add("ANIMATION_TIMES_NOT_RISING", f"/animations/{index}/times/{still}")
        for number, track in enumerate(clip["tracks"]):
            at = f"/animations/{index}/tracks/{number}"
            found.reference(track["gameObject"], "gameObjects", objects, f"{at}/gameObject")
            for name in ("localPosition", "localRotation"):
                keys = len(track.get(name, ()))
                if keys not in (0, len(times)):
                    found.add("ANIMATION_KEY_COUNT", f"{at}/{name}", keys=keys, times=len(times))
