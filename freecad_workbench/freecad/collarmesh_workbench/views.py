"""Registers how new objects are shown in FreeCAD's window, so that modules about the document need not import
modules about the window."""

import os

ICONS = os.path.join(os.path.dirname(__file__), "icons")
ICON = os.path.join(ICONS, "collarmesh.svg")
OUT_OF_DATE_ICON = os.path.join(ICONS, "collarmesh_out_of_date.svg")

_providers = {}


def register(kind, provider):
    """Registers the view provider for objects whose proxies have this `Type`."""
    _providers[kind] = provider


def show(kind, obj):
    """Shows an object. Does nothing without a window."""
    if kind in _providers:
        _providers[kind](obj.ViewObject)
