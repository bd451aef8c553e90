"""A compiler launcher for a project that fetches the sources: takes an object that another build has made by the same
command, or else runs the command.

    reuse.py COMMANDS BUILD FETCHED [LAUNCHER...] COMPILER ARGUMENT...

BUILD is the build folder of the other build, COMMANDS a file with its commands (`ninja -t compdb`), and FETCHED the
build folder of the sources in the project. An object is taken if the commands differ only in the names of these folders
and of the output and dependency files, and if the source and all headers generated in FETCHED have the same contents
as those of the other build.
"""

import json
import pathlib
import shlex
import shutil
import subprocess
import sys

ABOUT_FILES = {"-MD": 1, "-MT": 2, "-MF": 2, "-o": 2}  # words that do not change what is made


def option(words, name):
    return words[words.index(name) + 1] if name in words else ""


def essence(words):
    """Returns the arguments of a command that decide what is made."""
    found, i = [], 0
    while i < len(words):
        if words[i] in ABOUT_FILES:
            i += ABOUT_FILES[words[i]]
        else:
            found.append(words[i])
            i += 1
    return found


def headers_agree(build, fetched):
    """Returns whether the headers that were generated in one folder have the same bytes in the other."""
    for header in (path for kind in ("*.h", "*.hpp") for path in fetched.rglob(kind)):
        twin = build / header.relative_to(fetched)
        if not twin.exists() or twin.read_bytes() != header.read_bytes():
            return False
    return True


def made_before(table, build, fetched, words):
    """Returns the object that the other build has made by the same command, None if there is none."""
    if not headers_agree(build, fetched):
        return None
    source = option(words, "-c")
    moved = [word.replace(str(fetched), str(build)) for word in essence(words)]
    for entry in json.loads(table.read_text()):
        other, made = (pathlib.Path(entry["directory"], entry[name]) for name in ("file", "output"))
        if (str(other) == option(moved, "-c") and essence(shlex.split(entry["command"])) == moved and made.exists()
                and other.read_bytes() == pathlib.Path(source).read_bytes()):
            return made
    return None


def main():
    table, build, fetched = (pathlib.Path(word).absolute() for word in sys.argv[1:4])
    words = sys.argv[4:]
    made = made_before(table, build, fetched, words)
    if made is None:
        return subprocess.run(words).returncode
    output = option(words, "-o")
    shutil.copyfile(made, output)
    pathlib.Path(option(words, "-MF")).write_text(f"{output}:\n")
    with open(table.with_suffix(".taken"), "a") as file:
        file.write(f"{output}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
