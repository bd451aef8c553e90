"""Target edge lengths at the points of a mesh of tetrahedra, as a file for the program."""

import numpy

TETRAHEDRON = 10  # VTK's number


def write(path, points, tets, lengths):
    """Writes a .vtu file. `points`: (n, 3); `tets`: (m, 4); `lengths`: (n,)."""
    count = len(tets)
    with open(path, "w", encoding="ascii") as file:
        file.write('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>\n'
                   f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{count}">\n<Points>\n')
        _array(file, "points", "Float64", points, 3)
        file.write("</Points>\n<Cells>\n")
        _array(file, "connectivity", "Int64", tets)
        _array(file, "offsets", "Int64", numpy.arange(4, 4 * count + 1, 4))
        _array(file, "types", "UInt8", numpy.full(count, TETRAHEDRON))
        file.write("</Cells>\n<PointData>\n")
        _array(file, "size", "Float64", lengths)
        file.write("</PointData>\n</Piece>\n</UnstructuredGrid></VTKFile>\n")


def _array(file, name, kind, values, components=1):
    file.write(f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">\n')
    file.write(" ".join(map(repr, numpy.ravel(values).tolist())))
    file.write("\n</DataArray>\n")
