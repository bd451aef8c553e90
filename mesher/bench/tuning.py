"""Finds the size that makes a wanted number of tets, and remembers it between runs."""

from __future__ import annotations

import json
import math
import tempfile
from pathlib import Path

tolerance = 0.1     # relative difference of the number of tets above which results are marked
near_enough = 0.03  # relative difference that ends the search
trials = 8


class SizeCache:
    """A JSON file in the folder for temporary files, with sizes and the signatures of the meshers for which they were
    found. If a mesher has changed, its old size is still a good first guess."""

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
    """Returns the size at which `mesher` makes approximately the wanted number of tets: of the sizes tried, the one
    with the nearest number. It may be far from the wanted one if the number of tets jumps over it or never gets that
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
    """Returns the logarithm of the next size to try: by the secant of the last two trials, with a limited slope, or as
    if tets ~ size^-3 after the first one. Bisects if that is not between the nearest sizes with too many and with too
    few tets."""
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
