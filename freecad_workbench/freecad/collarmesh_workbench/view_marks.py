"""Shows places in the 3D view: selects sub-shapes, marks points and tetrahedra, and moves the camera."""

import contextlib

import FreeCAD
import FreeCADGui
import numpy

from . import compatibility, extent

NAME = "collarmesh_marks"
TRANSPARENCY = 80  # percent; transparency of the mesh while something in it is marked
AROUND = 0.15  # least visible radius around a point, relative to the diagonal


class ViewMarks:
    """Shows one set of places at a time, until `clear`."""

    def __init__(self, obj):
        self.object = obj
        self._node = None
        self._before = None  # previous appearance of the objects

    def show(self, places):
        self.clear()
        part = compatibility.meshed_object(self.object)
        points = [point for place in places for point in place.points]
        tetrahedra = [place.tetrahedra for place in places if place.tetrahedra is not None]
        subshapes = list(dict.fromkeys(name for place in places for name in place.subshapes))
        if not (points or tetrahedra or subshapes):
            return
        self._make_room(part, bool(subshapes))
        self._mark(points, numpy.concatenate(tetrahedra) if tetrahedra else numpy.zeros((0, 4, 3)))
        for name in subshapes:
            FreeCADGui.Selection.addSelection(part, name)
        self._look_at(points, tetrahedra, subshapes)

    def clear(self):
        """Restores the appearance of everything except the camera."""
        if self._node is not None:
            self.object.ViewObject.RootNode.removeChild(self._node)
            self._node = None
        if self._before is not None:
            FreeCADGui.Selection.clearSelection()
            part, visible, transparency = self._before
            self._before = None
            self.object.ViewObject.Transparency = transparency
            with contextlib.suppress(ReferenceError):  # the part may be deleted
                if part is not None and part.Document is not None:
                    part.ViewObject.Visibility = visible

    def _make_room(self, part, part_too):
        """Makes the mesh transparent. Shows the part if `part_too`, because its sub-shapes are selected; else hides
        it."""
        view = self.object.ViewObject
        FreeCADGui.Selection.clearSelection()
        self._before = part, part.ViewObject.Visibility if part else False, view.Transparency
        view.Transparency = TRANSPARENCY
        if part is not None:
            part.ViewObject.Visibility = part_too

    def _mark(self, points, tetrahedra):
        from pivy import coin

        self._node = coin.SoAnnotation()  # drawn over everything else
        self._node.setName(NAME)
        colour = coin.SoMaterial()
        colour.diffuseColor = (0.9, 0.1, 0.1)
        colour.emissiveColor = (0.25, 0, 0)
        self._node.addChild(colour)
        if len(tetrahedra):
            self._node.addChild(_faces(coin, tetrahedra))
        if points:
            self._node.addChild(_markers(coin, points))
        self.object.ViewObject.RootNode.addChild(self._node)

    def _look_at(self, points, tetrahedra, subshapes):
        box = FreeCAD.BoundBox()
        corners = numpy.concatenate(tetrahedra).reshape(-1, 3) if tetrahedra else ()
        for place in (*points, *corners):
            box.add(FreeCAD.Vector(*place))
        part = compatibility.meshed_object(self.object)
        for name in subshapes:
            of_subshape = extent.box_of_subshape(part, name)
            if of_subshape.isValid():
                box.add(of_subshape)
        if box.isValid():
            move_camera(self.object, box.Center, max(box.DiagonalLength, AROUND * extent.diagonal(part)))


def move_camera(obj, centre, radius):
    """Moves the camera so that everything within this radius (mm) of a point is visible, without changing its
    direction."""
    from pivy import coin

    views = FreeCADGui.getDocument(obj.Document.Name).mdiViewsOfType("Gui::View3DInventor")
    if not views or radius <= 0:
        return
    camera = views[0].getCameraNode()
    direction = camera.orientation.getValue().multVec(coin.SbVec3f(0, 0, -1))
    distance = camera.focalDistance.getValue()
    if camera.isOfType(coin.SoOrthographicCamera.getClassTypeId()):
        camera.height.setValue(2 * radius)
    else:
        distance = radius / numpy.tan(camera.heightAngle.getValue() / 2)
        camera.focalDistance.setValue(distance)
    camera.position.setValue(coin.SbVec3f(*centre) - direction * float(distance))


def _faces(coin, tetrahedra):
    group = coin.SoSeparator()
    points = coin.SoCoordinate3()
    points.point.setValues(0, 4 * len(tetrahedra), tetrahedra.reshape(-1, 3).tolist())
    faces = coin.SoIndexedFaceSet()
    indices = []
    lines, ends = coin.SoIndexedLineSet(), []
    for first in range(0, 4 * len(tetrahedra), 4):
        for a, b, c in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)):
            indices += [first + a, first + b, first + c, -1]
            ends += [first + a, first + b, first + c, first + a, -1]
    faces.coordIndex.setValues(0, len(indices), indices)
    lines.coordIndex.setValues(0, len(ends), ends)
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE  # lit from both sides
    hints.shapeType = coin.SoShapeHints.UNKNOWN_SHAPE_TYPE
    black, style = coin.SoBaseColor(), coin.SoDrawStyle()
    black.rgb = (0, 0, 0)
    style.lineWidth = 2
    for each in (hints, points, faces, black, style, lines):
        group.addChild(each)
    return group


def _markers(coin, points):
    """Returns red dots with a white rim."""
    group = coin.SoSeparator()
    places = coin.SoCoordinate3()
    places.point.setValues(0, len(points), [list(map(float, point)) for point in points])
    group.addChild(places)
    for pixels, rgb in ((16, (1, 1, 1)), (11, (0.9, 0.1, 0.1))):
        colour, style = coin.SoBaseColor(), coin.SoDrawStyle()
        colour.rgb = rgb
        style.pointSize = pixels
        for each in (colour, style, coin.SoPointSet()):
            group.addChild(each)
    return group
