"""The version of these sources, and the date that what is made of them has."""

import datetime
import os
import pathlib
import re
import subprocess

SOURCES = pathlib.Path(__file__).resolve().parents[1]


def version():
    """The project's."""
    text = (SOURCES / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(collarmesh VERSION ([\d.]+)", text)[1]


def date():
    """SOURCE_DATE_EPOCH, or the day of the last commit."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not seconds:
        git = ["git", "-C", SOURCES, "log", "-1", "--format=%ct"]
        seconds = subprocess.run(git, check=True, capture_output=True, text=True).stdout
    return datetime.datetime.fromtimestamp(int(seconds), datetime.timezone.utc).date().isoformat()
