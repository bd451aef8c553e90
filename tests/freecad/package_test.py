"""The Debian package holds an add-on that finds the program of the package.

    package_test.py BUILD CPACK

Exit code 77 (skipped) where dpkg-deb or FreeCAD are not installed.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def main():
    build, cpack = sys.argv[1:3]
    if not shutil.which("dpkg-deb"):
        print("dpkg-deb is not installed")
        return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-package-") as folder:
        folder = pathlib.Path(folder)
        subprocess.run([cpack, "-G", "DEB", "--config", f"{build}/CPackConfig.cmake", "-B", folder], check=True,
                       stdout=subprocess.DEVNULL)
        (package,) = folder.glob("*.deb")
        fields = subprocess.run(["dpkg-deb", "-f", package], check=True, capture_output=True, text=True).stdout
        print(fields)
        if "libc6" not in fields:
            raise SystemExit("the package does not name the libraries it needs")
        subprocess.run(["dpkg-deb", "-x", package, folder / "root"], check=True)
        usr = folder / "root" / "usr"
        if not (usr / "bin" / "collarmesh").exists():
            raise SystemExit("the package has no program")
        if (list(pathlib.Path(build).glob("python/collarmesh/_core*.so"))
                and not list(usr.glob("lib/python3/*/collarmesh/_core*.so"))):
            raise SystemExit("the package has no Python module")
        for file in ("share/doc/collarmesh/copyright", "share/doc/collarmesh/changelog.Debian.gz",
                     "share/man/man1/collarmesh.1.gz", "share/bash-completion/completions/collarmesh",
                     "share/zsh/vendor-completions/_collarmesh", "share/fish/vendor_completions.d/collarmesh.fish"):
            if not (usr / file).exists():
                raise SystemExit(f"the package has no {file}")
        for file in ("package.xml", "LICENSE"):
            if not (usr / "share" / "freecad" / "Mod" / "collarmesh" / file).exists():
                raise SystemExit(f"the add-on has no {file}")
        addon = usr / "share" / "freecad" / "Mod" / "collarmesh"
        return subprocess.run(
            [sys.executable, HERE / "run.py", "", HERE / "installed_test.py", "--addon", addon, "--", usr]
        ).returncode


if __name__ == "__main__":
    sys.exit(main())
