"""Finds the size at which a mesher makes a wanted number of tets, and keeps it for later runs."""

from __future__ import annotations

import json
import math
import tempfile
from pathlib import Path

tolerance = 0.1     # largest relative difference from the wanted number of tets for which tables have no mark
near_enough = 0.03  # relative difference from the wanted number of tets that ends the search
trials = 8


class SizeCache:
    """A JSON file in the folder for temporary files that keeps sizes, and with each size the signature of its mesher.
    If the mesher has changed since, the old size is still a good first guess."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.gettempdir()) / "collarmesh_bench"
        self.folder.mkdir(exist_ok=True)
        self.path = self.folder / "sizes.json"
        self.sizes = json.loads(self.path.read_text()) if self.path.exists() else {}

    def get(self, key: str) -> tuple[float, str] | None:
        return self.sizes.get(key)

    def put(self, key: str, size: float, signature: str) -> None:
        self.sizes[key] = size, signature
        self.path.write_text(json.dumps(self.sizes, indent=1))


def size_for(mesher, surface, target: int, folder: Path, cache: SizeCache) -> float:
    """Returns the size at which `mesher` makes approximately `target` tets: the best one of the sizes that were tried.
    The number of tets at this size may be far from `target` if it jumps from below to above `target` or never gets so
    low. Raises ProgramFailed if the mesher does."""
    key = f"{mesher.name} {surface.name} {len(surface.polygons)} {target} {near_enough}"
    size, signature = cache.get(key) or ((surface.volume / (0.12 * target)) ** (1 / 3), None)
    if signature == mesher.signature():
        return size
    found: list[tuple[float, float]] = []   # log size, log(tets / target)
    for _ in range(trials):
        found.append((math.log(size), math.log(mesher.mesh(surface, size, folder).tets / target)))
        if abs(found[-1][1]) <= math.log(1 + near_enough) or size > 2 * surface.diagonal:
            break
        size = math.exp(_next_trial(found))
    best = math.exp(min(found, key=lambda trial: abs(trial[1]))[0])
    cache.put(key, best, mesher.signature())
    return best


def _next_trial(found: list[tuple[float, float]]) -> float:
    """Returns the logarithm of the next size to try. After the first trial, assumes tets ~ size^-3; later uses the
    secant of the last two trials, with a limited slope. If the result is not between the nearest sizes with too many
    and with too few tets, returns the middle of these."""
    at, miss = found[-1]
    slope = -3.0
    if len(found) > 1 and found[-2][0] != at:
        slope = min(-0.5, max(-6.0, (miss - found[-2][1]) / (at - found[-2][0])))
    proposed = at - miss / slope
    finer = max((x for x, y in found if y > 0), default=-math.inf)
    coarser = min((x for x, y in found if y < 0), default=math.inf)
    if finer < coarser and not finer < proposed < coarser:
        proposed = (finer + coarser) / 2
    return proposed
