"""The version of these sources, and the date of packages that are made from them."""

import datetime
import os
import pathlib
import re
import subprocess

SOURCES = pathlib.Path(__file__).resolve().parents[1]


def version():
    """Returns the version of the project."""
    text = (SOURCES / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(collarmesh VERSION ([\d.]+)", text)[1]


def date():
    """Returns the day of SOURCE_DATE_EPOCH if that is set, else of the last commit: 2026-01-31."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not seconds:
        git = ["git", "-C", SOURCES, "log", "-1", "--format=%ct"]
        seconds = subprocess.run(git, check=True, capture_output=True, text=True).stdout
    return datetime.datetime.fromtimestamp(int(seconds), datetime.timezone.utc).date().isoformat()
