"""Markdown tables, and the few formulas of the reports."""

from __future__ import annotations

import math
import os
import platform
import re
import subprocess
from pathlib import Path


def table(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def si(value: float) -> str:
    """Returns a number as text with three digits and a suffix k or M: 1234567 as "1.23M"."""
    for limit, unit in ((1e6, "M"), (1e3, "k")):
        if float(f"{value:.3g}") >= limit:   # 999999 is 1M
            return f"{value / limit:.3g}{unit}"
    return f"{value:.3g}"


def tets_text(run) -> str:
    """Returns the number of tets as text, with the mark (7) if the mesh misses a guarantee."""
    return si(run.tets) + (" (7)" if run.guarantee_missed else "")


def seconds(value: float) -> str:
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def exponent(m1: float, t1: float, m2: float, t2: float) -> float:
    """Returns the exponent of growth t ~ m^exponent between two measurements."""
    return math.log(t2 / t1) / math.log(m2 / m1)


def machine(build: Path) -> str:
    cpuinfo = Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*: (.*)", cpuinfo)
    load = os.getloadavg()
    return (f"{model.group(1) if model else platform.processor()}, {os.cpu_count()} cores, "
            f"{platform.system()} {platform.release()}; pinned to one core; "
            f"load when started {load[0]:.1f}; {_compiler(build)}")


def _compiler(build: Path) -> str:
    cache = build / "CMakeCache.txt"
    if not cache.exists():
        return "compiler unknown"
    entries = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read_text(), re.MULTILINE))
    name = subprocess.run([entries["CMAKE_CXX_COMPILER"], "--version"], capture_output=True, text=True)
    return f"{name.stdout.splitlines()[0]}, {entries['CMAKE_BUILD_TYPE']}"
