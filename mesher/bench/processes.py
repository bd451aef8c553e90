"""Runs a program and measures it: CPU seconds, wall seconds, peak memory."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path


class ProgramFailed(Exception):
    """Raised if a program ends with an error, is killed or exceeds its time limit."""


@dataclass
class Measured:
    cpu: float         # seconds, user + system
    wall: float        # seconds
    peak_bytes: int    # largest resident set
    output: str        # standard output and standard error, mixed
    exit_code: int     # negative: the signal that ended the program


def pin_to_core(core: int | None) -> None:
    """Makes this process and its children run on one core only: on `core`, or on the last permitted one if None."""
    allowed = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {allowed[-1] if core is None else core})


use_memory = """
import mmap, sys
block = 64 << 20
filling, blocks = b"1" * block, []
for _ in range(int(sys.argv[1]) // block):
    memory = mmap.mmap(-1, block, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    try:
        memory.madvise(mmap.MADV_HUGEPAGE)
    except OSError:
        pass   # pages of another size do as well
    memory.write(filling)
    blocks.append(memory)
"""


def fetch_memory(most: int = 4 << 30) -> None:
    """Allocates up to `most` bytes of memory and frees them, so that the program that is measured next finds this
    memory ready: the host of a virtual machine is slow to hand out memory that was unused for a while. A separate
    process does this, because a measured program inherits the largest resident set of this script."""
    free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    subprocess.run([sys.executable, "-c", use_memory, str(min(most, free * 3 // 4))], check=True)


def run(command: list[str], folder: Path, time_limit: float, accepted: tuple[int, ...] = (0,)) -> Measured:
    """Runs a command. Raises ProgramFailed if the command exceeds the time limit (in wall seconds) or ends with an exit
    code that is not accepted. In the latter case the message quotes the first line of output that contains "error", or
    the last line if there is none."""
    log = folder / "output.txt"
    begin = time.perf_counter()
    with open(log, "wb") as out:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=subprocess.STDOUT)
    timer = threading.Timer(time_limit, process.kill)
    timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    wall = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    output = log.read_text(errors="replace")
    cpu = usage.ru_utime + usage.ru_stime
    if process.returncode in accepted:
        return Measured(cpu, wall, usage.ru_maxrss * 1024, output, process.returncode)
    if wall >= time_limit:
        raise ProgramFailed(f"not done in {time_limit:g} s")
    lines = output.strip().splitlines()
    told = next((line for line in lines if "error" in line.lower()), lines[-1] if lines else "no output")
    raise ProgramFailed(f"exit code {process.returncode}: {' '.join(told.split())[:100]}")


def run_limited(command: list[str], folder: Path, cpu_limit: int, memory_limit: int) -> Measured:
    """Runs a command with limits, and accepts any exit code. The limits are CPU seconds and bytes of address
    space. The program is also killed if its wall seconds exceed ten times the limit of CPU seconds."""
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (cpu_limit, cpu_limit + 1))
        resource.setrlimit(resource.RLIMIT_AS, (memory_limit, memory_limit))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    log = folder / "output.txt"
    begin = time.perf_counter()
    with open(log, "wb") as out:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=subprocess.STDOUT, preexec_fn=limit)
    timer = threading.Timer(10 * cpu_limit, process.kill)
    timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return Measured(usage.ru_utime + usage.ru_stime, time.perf_counter() - begin, usage.ru_maxrss * 1024,
                    log.read_text(errors="replace"), process.returncode)
