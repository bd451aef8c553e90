"""Find the size that gives a wanted number of tets, and remember it between runs."""

from __future__ import annotations

import json
import math
import tempfile
from pathlib import Path

tolerance = 0.1   # of the count
trials = 8


class SizeCache:
    """A JSON file in the folder for temporary files; sizes are forgotten when a mesher changes."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.gettempdir()) / "collarmesh_bench"
        self.folder.mkdir(exist_ok=True)
        self.path = self.folder / "sizes.json"
        self.sizes = json.loads(self.path.read_text()) if self.path.exists() else {}

    def get(self, key: str) -> float | None:
        return self.sizes.get(key)

    def put(self, key: str, size: float) -> None:
        self.sizes[key] = size
        self.path.write_text(json.dumps(self.sizes, indent=1))


def size_for(mesher, surface, target: int, folder: Path, cache: SizeCache) -> float:
    """The size at which `mesher` makes the wanted number of tets, within the tolerance; the nearest
    one found when its count jumps over it or never gets that low.
    Raises ProgramFailed when the mesher does."""
    key = f"{mesher.name} {mesher.signature()} {surface.name} {len(surface.polygons)} {target}"
    known = cache.get(key)
    if known is not None:
        return known
    size = (surface.volume / (0.12 * target)) ** (1 / 3)
    best, best_miss = size, math.inf
    finer, coarser = 0.0, math.inf   # sizes that gave too many, too few
    for _ in range(trials):
        tets = mesher.mesh(surface, size, folder).tets
        miss = abs(math.log(tets / target))
        if miss < best_miss:
            best, best_miss = size, miss
        if miss <= math.log(1 + tolerance) * 0.9 or size > 2 * surface.diagonal:
            break
        if tets > target:
            finer = max(finer, size)
        else:
            coarser = min(coarser, size)
        size *= (tets / target) ** (1 / 3)
        if not finer < size < coarser:
            size = finer * 2 if math.isinf(coarser) else math.sqrt(max(finer, coarser / 4) * coarser)
    cache.put(key, best)
    return best
