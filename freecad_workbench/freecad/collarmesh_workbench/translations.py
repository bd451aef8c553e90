"""Texts in the user's language, through Qt's files."""

import FreeCAD


def translate(context, text):
    """`text` in the language that FreeCAD shows; the context of all texts of this add-on is "collarmesh"."""
    return FreeCAD.Qt.translate(context, text)
