#!/usr/bin/env python3
"""Writes the add-on as FreeCAD's Add-on Manager wants it: a folder, or a .zip, with package.xml at its base and the
licence inside.

    make_package.py OUTPUT [--site URL] [--maintainer NAME] [--email ADDRESS] [--date YYYY-MM-DD]

OUTPUT ending in .zip holds a folder collarmesh, to be unpacked into FreeCAD's folder Mod. The options replace values of
the sources' package.xml; without --date, the date is that of the last commit, or of SOURCE_DATE_EPOCH. The program is
not in the add-on; packaging/make_archive.py makes an archive of both.
"""

import argparse
import pathlib
import re
import shutil
import sys
import tempfile
import zipfile
from xml.sax.saxutils import escape

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "packaging"))
import project  # noqa: E402
PARTS = ("freecad", "translations", "macros")
KINDS = {".py", ".svg", ".qm"}
SITE, MAINTAINER, EMAIL = "https://example.org/collarmesh", "The collarmesh maintainers", "collarmesh@example.org"
FIRST_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest date that a .zip file can hold


def metadata(site=SITE, maintainer=MAINTAINER, email=EMAIL, day=""):
    """Returns the text of package.xml. `day`: YYYY-MM-DD; empty: the default date."""
    text = (HERE / "package.xml").read_text(encoding="utf-8")
    for pattern, value in ((r"<version>.*?</version>", f"<version>{project.version()}</version>"),
                           (r"<date>.*?</date>", f"<date>{day or project.date()}</date>")):
        text, count = re.subn(pattern, value, text)
        if count != 1:
            raise SystemExit(f"package.xml has {count} times {pattern}")
    for before, after in ((SITE, site), (MAINTAINER, maintainer), (EMAIL, email)):
        text = text.replace(before, escape(after, {'"': "&quot;"}))
    return text


def lay_out(folder, **details):
    """Writes the add-on into a folder, which may exist. `details`: see `metadata`."""
    folder = pathlib.Path(folder)
    for source in sorted(path for part in PARTS for path in (HERE / part).rglob("*")):
        if source.suffix in KINDS and source.name != "update.py":
            target = folder / source.relative_to(HERE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
    shutil.copyfile(HERE.parent / "LICENSE", folder / "LICENSE")
    shutil.copyfile(HERE / "README.md", folder / "README.md")
    (folder / "package.xml").write_text(metadata(**details), encoding="utf-8")


def pack(folder, output):
    """Packs a folder into a .zip file. Equal files give equal bytes."""
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(str(pathlib.Path("collarmesh") / path.relative_to(folder)), FIRST_DATE)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())


def add_details(parser):
    """Adds command-line options for the arguments of `metadata`."""
    parser.add_argument("--site", default=SITE)
    parser.add_argument("--maintainer", default=MAINTAINER)
    parser.add_argument("--email", default=EMAIL)
    parser.add_argument("--date", default="", dest="day")


def main():
    parser = argparse.ArgumentParser(description="The add-on for FreeCAD's Add-on Manager.")
    parser.add_argument("output", type=pathlib.Path)
    add_details(parser)
    details = vars(parser.parse_args())
    output = details.pop("output")
    if output.suffix != ".zip":
        lay_out(output, **details)
        return
    with tempfile.TemporaryDirectory(prefix="collarmesh-addon-") as folder:
        lay_out(folder, **details)
        pack(pathlib.Path(folder), output)


if __name__ == "__main__":
    main()
