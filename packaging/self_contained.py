"""Makes a folder of programs and modules run where their libraries are not installed: the libraries are put beside
them, with run paths that are relative. The C library stays the system's, as it belongs to the kernel and to all other
processes; `glibc_needed` says which versions will do."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

# The loader and what comes with it.
C_LIBRARY = re.compile(
    r"(linux-vdso|ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv|anl|nsl|mvec|nss_.*|thread_db))\.so\.\d+")
# A process has one C++ library, which is the newest that any part of it needs: the program that loads a module brings
# it.
CXX_LIBRARY = re.compile(r"lib(stdc\+\+|gcc_s)\.so\.\d+")


def elf_files(folder):
    """Programs and shared libraries below a folder, links left out."""
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.is_file() and not path.is_symlink():
            with path.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield path


def _output(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def _libraries_of(file):
    """{name: path} of all that the loader brings in for a file. Raises SystemExit for one that is nowhere."""
    found = {}
    for line in _output("ldd", file).splitlines():
        name, arrow, rest = line.strip().partition(" => ")
        if not arrow:
            continue
        path = rest.split(" (")[0]
        if path == "not found":
            raise SystemExit(f"{file} needs {name}, which is not found")
        found[pathlib.Path(name).name] = path
    return found


def _needed_by(file):
    return _output("patchelf", "--print-needed", file).split()


def _unlike_others(path):
    """The name of a library with a hash of its content in it, so that no other of its name is taken for it."""
    digest = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:8]
    stem, dot, rest = pathlib.Path(path).name.partition(".so")
    return f"{stem}-{digest}{dot}{rest}"


def carry_libraries(folder, libraries, *, into_processes_of_others=False):
    """Copy what the files below `folder` need into the folder `libraries` below it. Returns where it came from.

    into_processes_of_others: the files are loaded by programs that have libraries of their own. Then the names of the
    copies are ones that nobody else has, and the C++ library is left to the program.
    """
    folder, libraries = pathlib.Path(folder), pathlib.Path(libraries)
    own = list(elf_files(folder))
    sources = {}
    for file in own:
        sources.update(_libraries_of(file))
    left = [C_LIBRARY] + [CXX_LIBRARY] * into_processes_of_others
    sources = {name: path for name, path in sources.items() if not any(pattern.fullmatch(name) for pattern in left)}
    names = {name: _unlike_others(path) if into_processes_of_others else name for name, path in sources.items()}
    libraries.mkdir(parents=True, exist_ok=True)
    for name, path in sources.items():
        copy = libraries / names[name]
        shutil.copyfile(path, copy)
        copy.chmod(0o755)
        if names[name] != name:
            subprocess.run(["patchelf", "--set-soname", names[name], copy], check=True)
    for file in [*own, *(libraries / name for name in names.values())]:
        _lead_to(file, libraries, names)
    return sorted(set(sources.values()))


def _lead_to(file, libraries, names):
    """Make a file look for its libraries in a folder, before all folders that the environment names."""
    for name in _needed_by(file):
        if names.get(name, name) != name:
            subprocess.run(["patchelf", "--replace-needed", name, names[name], file], check=True)
    kept = [part for part in _output("patchelf", "--print-rpath", file).strip().split(":")
            if part.startswith("$ORIGIN") and (file.parent / part.replace("$ORIGIN", ".")).is_dir()]
    to_libraries = os.path.relpath(libraries, file.parent)
    path = "$ORIGIN" if to_libraries == "." else f"$ORIGIN/{to_libraries}"
    wanted = [path, *(part for part in kept if part != path)] if file.parent != libraries else [path]
    subprocess.run(["patchelf", "--force-rpath", "--set-rpath", ":".join(wanted), file], check=True)


def glibc_needed(folder):
    """The oldest version of the GNU C library with which all files below a folder run: (2, 36)."""
    versions = [(2, 0)]
    for file in elf_files(folder):
        told = _output("objdump", "-T", file)
        versions += [tuple(map(int, version.split("."))) for version in re.findall(r"\bGLIBC_(\d+\.\d+)", told)]
    return max(versions)


def add_licences(libraries, folder):
    """Beside the libraries of Debian's packages, who may copy these."""
    folder.mkdir(parents=True, exist_ok=True)
    for library in libraries:
        for path in {library, os.path.realpath(library)}:
            owner = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True).stdout
            package = owner.split(":")[0]
            copyright = pathlib.Path("/usr/share/doc", package, "copyright")
            if package and copyright.exists():
                shutil.copyfile(copyright, folder / package)
