#!/usr/bin/env python3
"""shrink.py keeps only that facet of a box for which a command fails.

    shrink_test.py MODELS
"""
import pathlib
import subprocess
import sys
import tempfile

FAILS_AT_THE_ORIGIN = "import sys; sys.exit(3 if '\\n0 0 0\\n' in open(sys.argv[1]).read() else 0)"


def main():
    with tempfile.TemporaryDirectory() as folder:
        small = pathlib.Path(folder) / "small.off"
        subprocess.run([pathlib.Path(__file__).with_name("shrink.py"), pathlib.Path(sys.argv[1]) / "box.off", small,
                        "--", sys.executable, "-c", FAILS_AT_THE_ORIGIN, "{}"], check=True)
        lines = small.read_text().splitlines()
    if lines[1] != "3 1 0" or "0 0 0" not in lines:
        sys.exit(f"not one facet with the origin: {lines}")


if __name__ == "__main__":
    main()
