"""Registers how new objects are shown in FreeCAD's window, so that modules of the document need not import modules of
the window."""

import os

ICONS = os.path.join(os.path.dirname(__file__), "icons")
ICON = os.path.join(ICONS, "collarmesh.svg")
OUT_OF_DATE_ICON = os.path.join(ICONS, "collarmesh_out_of_date.svg")

_providers = {}


def register(kind, provider):
    """`kind` is the `Type` of the objects' proxies."""
    _providers[kind] = provider


def show(kind, obj):
    """Shows an object; does nothing without a window."""
    if kind in _providers:
        _providers[kind](obj.ViewObject)
