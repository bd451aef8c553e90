"""The panel's table of the solids' volumes: in the shape, in the mesh, and their difference."""

import dataclasses

from PySide import QtCore, QtGui

from . import colours, numbers_typed
from .translations import translate
from .whole_table import WholeTable

MOST = 6  # rows visible without scrolling
MUCH = 1  # percent; larger differences are highlighted
DIFFERENCE = 3  # number of the column


@dataclasses.dataclass
class Region:
    """Volumes in mm³."""

    name: str
    shape: float
    mesh: float
    percent: float


def in_report(report):
    """Returns the Regions of a run."""
    names = {each["region"]: each["name"] for each in report["complex"]["regions"]}
    return [Region(names.get(each["number"]) or _numbered(each["number"]), each["input"], each["mesh"], each["percent"])
            for each in report["check"]["kept"]["region_volumes"]]


def _numbered(number):
    return translate("collarmesh", "Region {number}").format(number=number)


def volume_text(volume):
    if volume >= 1e5:
        return numbers_typed.grouped(volume)
    return numbers_typed.shown(f"{volume:.6g}")


class RegionsTable(WholeTable):
    def __init__(self):
        super().__init__((translate("collarmesh", "in mm³"), translate("collarmesh", "Volume"),
                          translate("collarmesh", "in the mesh"), translate("collarmesh", "difference")), MOST)
        self.setObjectName("collarmesh_regions")
        self.setSelectionMode(QtGui.QAbstractItemView.NoSelection)
        self.setFocusPolicy(QtCore.Qt.NoFocus)
        self.setToolTip(translate("collarmesh",
                                  "Volumes of the shape and of its mesh. To bring them closer to each other, choose a "
                                  "smaller size or reduce “Largest distance from the shape”"))

    def show_report(self, report):
        self.clear()
        for region in in_report(report):
            row = self.add_row([region.name, volume_text(region.shape),
                               volume_text(region.mesh), _percent(region)])
            if abs(region.percent) > MUCH:
                colours.paint(row, DIFFERENCE, colours.CARE)
        self.setVisible(self.topLevelItemCount() > 0)
        self.fit()


def _percent(region):
    return numbers_typed.shown(f"{region.percent:+.2f} %")
