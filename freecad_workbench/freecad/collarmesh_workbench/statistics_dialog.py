"""A window with the statistics of a mesh: counts, angles, groups."""

import html

from PySide import QtCore, QtGui

from . import elements, groups, mesh_file
from .translations import translate

BAR = 160  # width of the longest bar in pixels


def page(mesh_object):
    """Returns the statistics as HTML. Raises MesherError."""
    fem_mesh = mesh_object.FemMesh
    if elements.dimension(fem_mesh) < 3:
        return _table(_rows_of_shell(fem_mesh)) + _groups(fem_mesh)
    mesh = mesh_file.statistics(mesh_object)
    rows = [
        (translate("collarmesh", "Tetrahedra"), f"{mesh['tets']}"),
        (translate("collarmesh", "Order of the elements"), f"{elements.order(fem_mesh)}"),
        (translate("collarmesh", "Nodes"), f"{fem_mesh.NodeCount}"),
        (translate("collarmesh", "Triangles on faces"), f"{mesh['faces']}"),
        (translate("collarmesh", "Median edge length"), f"{mesh['median_edge']:.4g} mm"),
        (translate("collarmesh", "Volume"), f"{sum(mesh['region_volumes'].values()):.6g} mm³"),
        (translate("collarmesh", "Smallest dihedral angle"), f"{mesh['min_dihedral']:.1f}°"),
        (translate("collarmesh", "Largest dihedral angle"), f"{mesh['max_dihedral']:.1f}°"),
    ]
    text = _table(rows)
    text += f"<h4>{translate('collarmesh', 'Smallest dihedral angle of each tetrahedron')}</h4>"
    return text + bars(mesh["histograms"]["min_dihedral"]) + _groups(fem_mesh)


def _rows_of_shell(fem_mesh):
    """Returns table rows for a mesh of triangles or lines."""
    of_triangles = elements.dimension(fem_mesh) == 2
    name = translate("collarmesh", "Triangles") if of_triangles else translate("collarmesh", "Lines")
    return [(name, f"{len(elements.numbers(fem_mesh))}"),
            (translate("collarmesh", "Order of the elements"), f"{elements.order(fem_mesh)}"),
            (translate("collarmesh", "Nodes"), f"{fem_mesh.NodeCount}")]


def _table(rows):
    return "<table cellspacing='4'>" + "".join(
        f"<tr><td>{name}</td><td align='right'><b>{value}</b></td></tr>" for name, value in rows
    ) + "</table>"


def _groups(fem_mesh):
    names = sorted(groups.named(fem_mesh).items(), key=lambda group: group[1])
    text = f"<h4>{translate('collarmesh', 'Groups')}</h4><table cellspacing='4'>"
    for name, number in names:
        count = len(fem_mesh.getGroupElements(number))
        text += f"<tr><td>{html.escape(name)}</td><td align='right'>{count}</td></tr>"
    return text + "</table>"


def bars(histogram):
    counts, width = histogram["tets"], histogram["bin_width"]
    most = max(*counts, 1)
    text = "<table cellspacing='0' cellpadding='2'>"
    for i, count in enumerate(counts):
        if count:
            pixels = max(1, round(BAR * count / most))
            text += (f"<tr><td align='right'>{i * width}° - {(i + 1) * width}°</td><td align='right'>{count}</td>"
                     "<td><table cellspacing='0'><tr><td bgcolor='#8ec07c' "
                     f"width='{pixels}'>&nbsp;</td></tr></table></td></tr>")
    return text + "</table>"


def show(mesh_object, parent):
    """Opens the window and returns it. Raises MesherError."""
    text = page(mesh_object)
    dialog = QtGui.QDialog(parent)
    dialog.setObjectName("collarmesh_statistics")
    dialog.setWindowTitle(translate("collarmesh", "Statistics of {label}").format(label=mesh_object.Label))
    dialog.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    dialog.resize(460, 620)
    browser = QtGui.QTextBrowser(dialog)
    browser.setHtml(text)
    buttons = QtGui.QDialogButtonBox(QtGui.QDialogButtonBox.Close, parent=dialog)
    buttons.rejected.connect(dialog.reject)
    layout = QtGui.QVBoxLayout(dialog)
    layout.addWidget(browser)
    layout.addWidget(buttons)
    dialog.show()
    return dialog
