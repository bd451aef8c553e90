"""Rejects invalid sizes before anything runs. Works without the GUI."""

from . import extent
from .program import MesherError
from .translations import translate

LEAST = 1e-5  # smallest size, relative to the part's diagonal


def check(settings, sources, part):
    """Checks sizes. `sources` are those of the size field, with their labels. Raises MesherError, which names
    the wrong size."""
    diagonal = extent.diagonal(part)
    asked = [(translate("collarmesh", "Size of the elements"), settings.size)] if settings.size else []
    for kind, sizes in (("Solid", settings.solid_sizes), ("Face", settings.face_sizes), ("Edge", settings.edge_sizes)):
        asked += [(f"{kind}{number}", size) for number, size in sizes.items()]
    asked += [(label, source["size"]) for label, source in sources]
    for label, size in asked:
        if not 0 < size < float("inf"):
            raise MesherError(
                translate("collarmesh", "{label}: a size of {size:g} mm makes no sense, it has to be more than 0."),
                label=label, size=size)
        if size < LEAST * diagonal:
            raise MesherError(translate("collarmesh", "{label}: {size:g} mm is less than a hundred thousandth of the "
                                                      "part, which is {diagonal:.4g} mm large. Choose a larger size."),
                              label=label, size=size, diagonal=diagonal)
