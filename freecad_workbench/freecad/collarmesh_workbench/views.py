"""How new objects show in FreeCAD's window. The modules of the window register that here, so that those of the document
need not know them."""

import os

ICONS = os.path.join(os.path.dirname(__file__), "icons")
ICON = os.path.join(ICONS, "collarmesh.svg")
OUT_OF_DATE_ICON = os.path.join(ICONS, "collarmesh_out_of_date.svg")

_providers = {}


def register(kind, provider):
    """`kind`: the `Type` of the objects' proxies."""
    _providers[kind] = provider


def show(kind, obj):
    """Nothing without a window."""
    if kind in _providers:
        _providers[kind](obj.ViewObject)
