#!/usr/bin/python3
"""The Debian package: what is in it and what is not, and no error by lintian.

    debian_test.py BUILD CPACK
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WANTED = ["usr/bin/collarmesh", "usr/share/doc/collarmesh/copyright", "usr/share/doc/collarmesh/changelog.Debian.gz",
          "usr/share/doc/collarmesh/changelog.gz", "usr/share/man/man1/collarmesh.1.gz",
          "usr/share/bash-completion/completions/collarmesh", "usr/share/zsh/vendor-completions/_collarmesh",
          "usr/share/fish/vendor_completions.d/collarmesh.fish"]


def main():
    build, cpack = sys.argv[1:3]
    missing = [program for program in ("dpkg-deb", "lintian") if shutil.which(program) is None]
    if missing:
        print(f"{missing} not installed")
        return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-package-") as folder:
        subprocess.run([cpack, "-G", "DEB", "--config", f"{build}/CPackConfig.cmake", "-B", folder], check=True,
                       stdout=subprocess.DEVNULL)
        (package,) = pathlib.Path(folder).glob("*.deb")
        listed = subprocess.run(["dpkg-deb", "-c", package], check=True, capture_output=True, text=True).stdout
        files = {line.split()[5].removeprefix("./") for line in listed.splitlines()}
        if lacking := set(WANTED) - files:
            raise SystemExit(f"the package lacks {lacking}")
        if unwanted := [file for file in files
                        if re.search(r"bench|/tests?/|gtest|acute_shape", file.replace("workbench", ""))]:
            raise SystemExit(f"the package has {unwanted}")
        found = subprocess.run(["lintian", "--allow-root", "--fail-on", "error",
                               package], capture_output=True, text=True)
        print(found.stdout, found.stderr)
        return found.returncode


if __name__ == "__main__":
    sys.exit(main())
