"""The program: `python -m collarmesh part.step -o part.vtu`, like the command `collarmesh`."""

import os
import pathlib
import shutil
import sys


def program() -> str:
    """Returns the program that came with the package, else the one on the PATH."""
    own = pathlib.Path(__file__).resolve().parent / "bin" / "collarmesh"
    if own.exists():
        return str(own)
    command = pathlib.Path(sys.argv[0])
    for folder in os.get_exec_path():  # the package's own command may be on the path
        found = shutil.which("collarmesh", path=folder)
        if found is not None and not (command.exists() and os.path.samefile(found, command)):
            return found
    raise SystemExit("collarmesh: the program is neither in the package nor on the PATH; install the package by pip, "
                     "or build the program with ./collarmesh in a clone")


def main() -> None:
    found = program()
    sys.stdout.flush()
    os.execv(found, ["collarmesh", *sys.argv[1:]])


if __name__ == "__main__":
    main()
