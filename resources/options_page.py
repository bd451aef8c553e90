#!/usr/bin/env python3
"""Writes the tables of options, one for each group, into their page, mesher/doc/options.md.

    options_page.py PROGRAM [PAGE]
"""

import json
import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parents[1] / "mesher" / "doc" / "options.md"
HEAD = "| option | default | meaning |\n|---|---|---|\n"
BEGIN, END = "<!-- options: written by resources/options_page.py -->\n\n", "\n<!-- end of options -->\n"
TABLES = re.compile(re.escape(BEGIN) + ".*" + re.escape(END), re.S)


def code(text, words=()):
    """Formats options, and words that can be chosen, as code."""
    text = re.sub(r"(--[a-z][a-z-]*(?: wrap| \d)?)", r"`\1`", text)
    return re.sub(rf"\b({'|'.join(words)})(?=:)", r"`\1`", text) if words else text


def range_of(option):
    """Returns the range of an option as text; empty if it has no upper end, or if the help explains each number."""
    low, high = option["low"], option["high"]
    if option["kind"] not in ("number", "count") or high is None or high > 1e9:
        return ""
    if option["kind"] == "count" and high - low < 4:
        return ""
    return f"{low:.9g} to {high:.9g}"


def row(option):
    names = f"`--{option['name']}`"
    if option["words"]:
        names += " " + ", ".join(f"`{word}`" for word in option["words"])
    elif option["value_name"]:
        names = f"`--{option['name']} {option['value_name']}`"
    if option["letter"]:
        names = f"`-{option['letter']}`, {names}"
    default = option["default_text"]
    if option["kind"] in ("text", "texts", "sizes"):
        default = "none"
    elif option["words"]:
        default = f"`{default}`"
    meaning = [code(option["help"][0].lower() + option["help"][1:], option["words"]), range_of(option),
               option["details"], "repeatable" if option["kind"] in ("texts", "sizes") else ""]
    return f"| {names} | {code(default)} | {'; '.join(filter(None, meaning))} |\n"


def page(text, program):
    """Returns the text of the page with the tables of this program."""
    said = subprocess.run([program, "--generate", "options"], check=True, capture_output=True, text=True).stdout
    groups = {}
    for option in json.loads(said):
        if "mesh" in option["takers"]:
            groups.setdefault(option["group"], []).append(row(option))
    if not TABLES.search(text):
        raise SystemExit("the page has no tables of options")
    tables = "\n".join(
        f"## {group.replace('Options', 'Run')}\n\n{HEAD}{''.join(rows)}" for group, rows in groups.items())
    return TABLES.sub(lambda _: BEGIN + tables + END, text)


def main():
    path = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else PAGE
    path.write_text(page(path.read_text(encoding="utf-8"), sys.argv[1]), encoding="utf-8")


if __name__ == "__main__":
    main()
