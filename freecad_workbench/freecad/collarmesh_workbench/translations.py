"""Texts in the user's language, through Qt's files."""

import pathlib

import FreeCAD

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "translations"


def load():
    """Show the files' language in FreeCAD's window; texts that are asked for before are English."""
    import FreeCADGui

    FreeCADGui.addLanguagePath(str(FOLDER))
    FreeCADGui.updateLocale()


def translate(context, text):
    """`text` in the language that FreeCAD shows; the context of all texts of this add-on is "collarmesh"."""
    return FreeCAD.Qt.translate(context, text)


def mark(_context, text):
    """`text` as it is, but with an entry in the files: it is translated where it is shown."""
    return text


def doc(text):
    """A property's documentation, which FreeCAD translates where it shows it (context "App::Property")."""
    return text
