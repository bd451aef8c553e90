"""A root folder with only this system's C library and its loader: a program runs in it only if it brings
everything else."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

C_LIBRARY = ("libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libresolv.so.2", "libutil.so.1")


def enter():
    """Returns the command that runs another one with its own root, {}; None if the system does not permit
    that."""
    script = 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"'
    rights = [] if os.geteuid() == 0 else ["--map-root-user"]
    command = ["unshare", *rights, "--mount", "--pid", "--fork"]
    if shutil.which("unshare") is None or subprocess.run([*command, "true"], capture_output=True).returncode != 0:
        return None
    return [*command, "sh", "-c", script]


def make(root):
    """Makes a root with only the C library and its loader."""
    root = pathlib.Path(root)
    for folder in ("proc", "tmp", "lib64"):
        (root / folder).mkdir(parents=True)
    (root / "lib").symlink_to("lib64")
    told = subprocess.run(["ldd", sys.executable], check=True, capture_output=True, text=True).stdout
    loader = pathlib.Path(re.search(r"(/\S*ld-linux\S*)", told)[1])
    folder = pathlib.Path(re.search(r"=> (/\S*/libc\.so\.6)", told)[1]).parent
    for source in (loader, *(folder / name for name in C_LIBRARY)):
        shutil.copy(source, root / "lib64")


def run(root, *command):
    """Runs a program in the root that `make` has made; returns the completed process."""
    return subprocess.run([*enter(), root, *map(str, command)], capture_output=True, text=True,
                          env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LD_LIBRARY_PATH": "/tmp"})
