"""Texts in the user's language, by Qt's translation files."""

import pathlib

import FreeCAD

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "translations"


def load():
    """Installs the translations for the language of FreeCAD's window. Texts that were translated before stay
    English."""
    import FreeCADGui

    FreeCADGui.addLanguagePath(str(FOLDER))
    FreeCADGui.updateLocale()


def translate(context, text):
    """Returns `text` in FreeCAD's language; the context of all texts of this add-on is "collarmesh"."""
    return FreeCAD.Qt.translate(context, text)


def mark(_context, text):
    """Returns `text` unchanged. The call makes an entry in the files, so that the text can be translated
    where it is shown."""
    return text


def doc(text):
    """Marks the documentation of a property. FreeCAD translates it when it shows it (context
    "App::Property")."""
    return text
