"""Bring the translations up to date with the sources: translations/update.py [--check]

Copies the texts of all calls of `translate`, `mark` and `doc` into each collarmesh_LANGUAGE.ts. New texts are
"unfinished" there until someone translates them, with Qt Linguist or an editor; texts that are gone are dropped. Then
Qt's lrelease makes the .qm files that FreeCAD reads. They are kept with the sources, because whoever clones the add-on
may lack lrelease.
--check changes nothing and fails if a text has no translation.
"""

import ast
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent
SOURCES = HERE.parent / "freecad" / "collarmesh_workbench"
MARKED_ELSEWHERE = (ast.Name, ast.Attribute, ast.Subscript, ast.Call)
OF_PROPERTIES = "App::Property"  # the context in which FreeCAD looks up texts of properties


def texts(folder=SOURCES):
    """Returns {(context, text)} of all sources except translations.py, which defines the three functions."""
    paths = [path for path in sorted(folder.glob("*.py")) if path.name != "translations.py"]
    return set().union(*(texts_in(path.read_text(encoding="utf-8"), path.name) for path in paths))


def texts_in(source, name=""):
    """Returns {(context, text)} of a source. Raises ValueError for a text that is no constant."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        function = getattr(getattr(node, "func", None), "id", "")
        if function not in ("translate", "mark", "doc"):
            continue
        if function == "translate" and isinstance(node.args[1], MARKED_ELSEWHERE):
            continue
        words = [each.value if isinstance(each, ast.Constant) else None for each in node.args]
        if function == "doc":
            words.insert(0, OF_PROPERTIES)
        if None in words:
            raise ValueError(f"{name}:{node.lineno}: {function} needs constants")
        found.add(tuple(words))
    return found


def read(path):
    """Returns {(context, text): translation}, with None for unfinished ones."""
    if not path.exists():
        return {}
    return {
        (context.findtext("name"), message.findtext("source")): None
        if message.find("translation").get("type")
        else message.findtext("translation")
        for context in ElementTree.parse(path).getroot().iter("context")
        for message in context.iter("message")
    }


def write(path, translations, language):
    root = ElementTree.Element("TS", version="2.1", language=language, sourcelanguage="en")
    for name in sorted({context for context, _ in translations}):
        context = ElementTree.SubElement(root, "context")
        ElementTree.SubElement(context, "name").text = name
        for text in sorted(text for of, text in translations if of == name):
            message = ElementTree.SubElement(context, "message")
            ElementTree.SubElement(message, "source").text = text
            translated = ElementTree.SubElement(message, "translation")
            if translations[name, text] is None:
                translated.set("type", "unfinished")
            else:
                translated.text = translations[name, text]
    ElementTree.indent(root)
    body = ElementTree.tostring(root, encoding="unicode")
    path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n', encoding="utf-8")


def missing(path):
    """Returns two lists of (context, text): of the sources without a translation in a file, and of the file without a
    text in the sources."""
    have, wanted = read(path), texts()
    return sorted(key for key in wanted if not have.get(key)), sorted(have.keys() - wanted)


def main():
    files = sorted(HERE.glob("collarmesh_*.ts"))
    for path in files:
        if "--check" not in sys.argv:
            have = read(path)
            write(path, {key: have.get(key) for key in texts()}, path.stem.removeprefix("collarmesh_"))
            lrelease = shutil.which("lrelease") or shutil.which("lrelease-qt5")
            if lrelease is None:
                sys.exit(
                    "lrelease is not installed (Debian: qttools5-dev-tools); the .qm files are as before"
                )
            subprocess.run([lrelease, "-silent", path], check=True)
        untranslated, _ = missing(path)
        for context, text in untranslated:
            print(f"{path.name}: {context}: no translation of: {text}")
        if untranslated:
            sys.exit(1)


if __name__ == "__main__":
    main()
