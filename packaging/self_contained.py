"""Makes a folder of programs and modules run where their libraries are not installed: puts the libraries beside them
and sets relative run paths. The C library is not included, because it has to fit the system; `glibc_needed` returns the
oldest version that suffices."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

# The dynamic loader and the libraries of the GNU C library.
C_LIBRARY = re.compile(
    r"(linux-vdso|ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv|anl|nsl|mvec|nss_.*|thread_db))\.so\.\d+")
# A process has only one C++ library, which must be as new as any part of the process needs: a module uses that of the
# program that loads it.
CXX_LIBRARY = re.compile(r"lib(stdc\+\+|gcc_s)\.so\.\d+")


def elf_files(folder):
    """Yields the programs and shared libraries below a folder, without links."""
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.is_file() and not path.is_symlink():
            with path.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield path


def _output(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def _libraries_of(file):
    """Returns {name: path} of all libraries that the loader loads for a file. Raises SystemExit if one is not found."""
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
    """Returns the name of a library with a hash of its content, so that no other library has the same name."""
    digest = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:8]
    stem, dot, rest = pathlib.Path(path).name.partition(".so")
    return f"{stem}-{digest}{dot}{rest}"


def carry_libraries(folder, libraries, *, into_processes_of_others=False):
    """Copies the libraries that the files below `folder` need into the folder `libraries` below it. Returns the paths
    of the originals.

    into_processes_of_others: programs that have libraries of their own load the files. Then the copies get unique
    names, and the C++ library is not copied.
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
    """Makes a file look for its libraries in a folder before it looks in the folders that the environment names."""
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
    """Returns the oldest version of the GNU C library with which all files below a folder run, such as (2, 36)."""
    versions = [(2, 0)]
    for file in elf_files(folder):
        told = _output("objdump", "-T", file)
        versions += [tuple(map(int, version.split("."))) for version in re.findall(r"\bGLIBC_(\d+\.\d+)", told)]
    return max(versions)


def add_licences(libraries, folder):
    """Copies the licences of the Debian packages that have these libraries into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for library in libraries:
        for path in {library, os.path.realpath(library)}:
            owner = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True).stdout
            package = owner.split(":")[0]
            copyright = pathlib.Path("/usr/share/doc", package, "copyright")
            if package and copyright.exists():
                shutil.copyfile(copyright, folder / package)
