"""The package for FreeCAD's Add-on Manager has what that asks for at its base, the same bytes each time, and works
where it is unpacked.

    addon_test.py PROGRAM

Exit code 77 (skipped) where FreeCAD is not installed.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
MAKE = HERE.parents[1] / "freecad_workbench" / "make_package.py"
NAMES = {"p": "https://wiki.freecad.org/Package_Metadata"}


def require(condition, what):
    if not condition:
        raise SystemExit(what)


def make(output, *options):
    subprocess.run([sys.executable, MAKE, output, *options], check=True)
    return output.read_bytes()


def check_metadata(addon, program):
    root = ElementTree.parse(addon / "package.xml").getroot()

    def text(path):
        return root.findtext(path, "", NAMES)

    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    require(text("p:version") == version, f"the program is {version}, the package {text('p:version')}")
    require(text("p:date") == "2020-09-13", f"the date is {text('p:date')}")
    for person in ("maintainer", "author"):
        email = root.find(f"p:{person}", NAMES).get("email")
        require(text(f"p:{person}") == "A & B" and email == "a@b.example",
                f"{person} is {text(f'p:{person}')}, {email}")
    urls = {each.get("type"): each for each in root.findall("p:url", NAMES)}
    require({"website", "repository", "bugtracker", "documentation"} <= urls.keys(), f"URLs are {list(urls)}")
    require(all(each.text.startswith("https://b.example/mesh") for each in urls.values()), "URLs of the site")
    require(urls["repository"].get("branch"), "the branch")
    require(len(root.findall("p:content/p:workbench/p:tag", NAMES)) > 2, "tags")
    require("GNU GENERAL PUBLIC LICENSE" in (addon / root.find("p:license", NAMES).get("file")).read_text(),
            "the licence")
    for icon in ("p:icon", "p:content/p:workbench/p:icon"):
        require((addon / text(icon)).exists(), f"no icon {text(icon)}")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="collarmesh-addon-") as folder:
        folder = pathlib.Path(folder)
        os.environ["SOURCE_DATE_EPOCH"] = "1600000000"
        options = ("--site", "https://b.example/mesh", "--maintainer", "A & B", "--email", "a@b.example")
        packed = [make(folder / f"{name}.zip", *options) for name in ("first", "second")]
        require(packed[0] == packed[1], "the package has the same bytes each time")
        with zipfile.ZipFile(folder / "first.zip") as archive:
            archive.extractall(folder)
        addon = folder / "collarmesh"
        check_metadata(addon, program)
        strange = [path for path in addon.rglob("*") if path.suffix in (".cpp", ".ts", ".pyc") or path.is_symlink()]
        require(not strange, f"{strange} are none of the add-on")
        return subprocess.run([sys.executable, HERE / "run.py", program, HERE / "addon_in_freecad.py", "--addon", addon,
                               "--", addon / "package.xml"]).returncode


if __name__ == "__main__":
    sys.exit(main())
