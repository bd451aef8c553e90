"""The common faces and edges of touching solids. The mesh contains a common part once, with the smallest of
its numbers. Works without the GUI."""

import collections
import dataclasses
import functools

import numpy

SAME_PLACE = 1e-6  # relative to the shape's diagonal
SHARE = 1e-6  # share of a face's area or an edge's length; smaller common parts do not count
ANALYTIC = ("Plane", "Cylinder", "Cone", "Sphere", "Toroid", "Line", "Circle", "Ellipse")
KINDS = ("Face", "Edge")
SOURCES = {"patches": "Face", "curves": "Edge"}  # names in the program's size field
SHAPES = 5  # number of shapes that are remembered

_known = collections.deque(maxlen=SHAPES)  # Contacts of recent shapes


def of(shape):
    """Returns the Contacts of a shape, which may be null."""
    if shape.isNull():
        return Contacts(shape)
    found = next((each for each in _known if each.shape.isSame(shape)), None)
    if found is None:
        found = Contacts(shape)
        _known.append(found)
    return found


def in_mesh_numbers(settings, shape):
    """Returns Settings in which faces and edges have the mesh's numbers. A size for a face applies to all faces of the
    mesh that are parts of it, and so do layers. `keep_apart` is False if no solids touch."""
    here = of(shape)
    sizes = {}
    for field, kind in (("face_sizes", "Face"), ("edge_sizes", "Edge")):
        sizes[field] = {}
        for number, size in getattr(settings, field).items():
            for tag in here.tags(kind, number):
                sizes[field][tag] = min(size, sizes[field].get(tag, size))
    return dataclasses.replace(settings, size_field=_field_in_mesh_numbers(settings.size_field, here),
                               keep_apart=settings.keep_apart and bool(here.glued_faces()),
                               layers=[_layers_in_mesh_numbers(text, here) for text in settings.layers], **sizes)


def _field_in_mesh_numbers(field, here):
    if not field:
        return field
    sources = [dict(source) for source in field["sources"]]
    for source in sources:
        for name, kind in SOURCES.items():
            if name in source:
                source[name] = sorted({tag for number in source[name] for tag in here.tags(kind, number)})
    return {**field, "sources": sources}


def _layers_in_mesh_numbers(text, here):
    """Converts the numbers of faces in the text of layers, "1,5:first=0.1"; names stay as they are."""
    faces, colon, settings = text.partition(":")
    tags = [here.tags("Face", int(face)) if face.isdigit() else [face] for face in faces.split(",")]
    return ",".join(dict.fromkeys(str(tag) for each in tags for tag in each)) + colon + settings


class Contacts:
    """The contacts of one shape. Names are FreeCAD's: `kind` is Face or Edge, and numbers begin with 1."""

    def __init__(self, shape):
        self.shape = shape
        several = not shape.isNull() and len(shape.Solids) > 1
        self._of_kind = {kind: _ContactsOfKind(shape, kind) for kind in KINDS} if several else {}

    def tags(self, kind, number):
        """Returns the numbers that the parts of Face7 (for "Face" and 7) have in the mesh."""
        return self._of_kind[kind].tags(number) if kind in self._of_kind else [number]

    def has_all(self, kind, tag, number):
        """Returns whether everything that has the number `tag` in the mesh is a part of Face7. Precondition:
        `tag` is one of the face's tags."""
        return tag == number or self._of_kind[kind].has_all(tag, number)

    def names(self, kind, tag):
        """Returns the names of the faces or edges that may have a part with this number in the mesh: Face7,
        Face9."""
        return [f"{kind}{number}" for number in (tag, *self._larger(kind, tag))]

    def numbers(self, kind):
        """Returns the numbers of all faces or edges; none in a shape of one solid."""
        return range(1, len(self._of_kind[kind].elements) + 1) if kind in self._of_kind else ()

    def in_contact(self, kind):
        """Returns the numbers of the faces or edges that have a part with a smaller number in the mesh."""
        return [number for number in self.numbers(kind) if self.tags(kind, number) != [number]]

    def solids(self, kind, number):
        """Returns the numbers of the solids that Face7 belongs to. Precondition: there are several solids."""
        return sorted(solid + 1 for solid in self._of_kind[kind].solids[number - 1])

    def name(self, kind, tag):
        """Returns one name for all faces or edges with this number in the mesh: "Face7 = Face9"."""
        return " = ".join(self.names(kind, tag))

    def glued_faces(self):
        """Returns pairs of numbers of faces with a common part; a pair of equal numbers for a face that two
        solids share already."""
        if not self._of_kind:
            return []
        holders = self._of_kind["Face"].solids
        return [(number, other) for number, solids in enumerate(holders, 1)
                for other in (*([number] if len(solids) > 1 else []), *self._larger("Face", number))]

    def _larger(self, kind, number):
        of_kind = self._of_kind.get(kind)
        if of_kind is None or number > len(of_kind.elements):
            return []
        return [other for other in of_kind.met(number) if other > number]


class _ContactsOfKind:
    """The contacts between faces, or those between edges."""

    def __init__(self, shape, kind):
        self.shape, self.kind = shape, kind
        self.elements = getattr(shape, kind + "s")
        self.tolerance = SAME_PLACE * shape.BoundBox.DiagonalLength
        self._pairs, self._left = {}, {}  # known answers of `_meet` and `_is_left`

    @functools.cached_property
    def solids(self):
        """Returns for each element the set of solids that it belongs to, numbered from 0."""
        members = collections.defaultdict(list)
        for i, solid in enumerate(self.shape.Solids):
            for each in getattr(solid, self.kind + "s"):
                members[each.hashCode()].append((i, each))
        return [{i for i, member in members[each.hashCode()] if member.isSame(each)} for each in self.elements]

    @functools.cached_property
    def boxes(self):
        """Returns a row for each element's box: its lower corner, then its negated upper corner."""
        boxes = [each.BoundBox for each in self.elements]
        return numpy.array([(b.XMin, b.YMin, b.ZMin, -b.XMax, -b.YMax, -b.ZMax) for b in boxes]).reshape(-1, 6)

    def met(self, number):
        """Returns the numbers of elements of other solids that have a common part with this element."""
        return [other for other in self._near(number) if self._meet(min(number, other), max(number, other))]

    def tags(self, number):
        if number > len(self.elements):  # the program reports that the element is missing
            return [number]
        tags = [other for other in self.met(number) if other < number and self._is_left(other)]
        return [*tags, number] if self._is_left(number) else tags

    def has_all(self, tag, number):
        other = self.elements[tag - 1]
        return _is_nothing(other.cut(self.elements[number - 1]), other)

    def _is_left(self, number):
        """Returns whether a part of the element has its number in the mesh."""
        if number not in self._left:
            element = self.elements[number - 1]
            smaller = [self.elements[other - 1] for other in self.met(number) if other < number]
            self._left[number] = not smaller or not _is_nothing(element.cut(smaller), element)
        return self._left[number]

    def _near(self, number):
        """Returns the numbers of elements of other solids whose boxes meet the element's box."""
        opposite = -self.boxes[number - 1][[3, 4, 5, 0, 1, 2]]
        meet = (self.boxes <= opposite + self.tolerance).all(axis=1)
        mine = self.solids[number - 1]
        return [int(i) + 1 for i in numpy.flatnonzero(meet) if not self.solids[i] & mine]

    def _meet(self, *numbers):
        """Returns whether two elements have a common part."""
        if numbers not in self._pairs:
            a, b = (self.elements[number - 1] for number in numbers)
            is_possible = not self._seams & set(numbers) and _may_coincide(a, b, self.tolerance)
            self._pairs[numbers] = is_possible and not _is_nothing(a.common(b), a)
        return self._pairs[numbers]

    @functools.cached_property
    def _seams(self):
        """Returns the numbers of seams and degenerate edges: the mesh has no such edges."""
        if self.kind == "Face":
            return set()
        seams = collections.defaultdict(list)
        for face in self.shape.Faces:
            for edge in face.Edges:
                if edge.Degenerated or edge.isSeam(face):
                    seams[edge.hashCode()].append(edge)
        return {number for number, edge in enumerate(self.elements, 1)
                if any(edge.isSame(other) for other in seams[edge.hashCode()])}


def is_seam(shape, edge):
    """Returns whether the edge is a face's seam or degenerate: the mesh has no such edge."""
    return edge.Degenerated or any(edge.isSeam(face) for face in shape.Faces if any(edge.isSame(e) for e in face.Edges))


def _is_nothing(part, whole):
    """Returns whether the part's area or length is negligible."""
    if whole.ShapeType == "Face":
        return part.Area <= SHARE * whole.Area
    return part.Length <= SHARE * whole.Length


def _may_coincide(a, b, tolerance):
    """Returns False if two elements surely have no common part: if both are analytic (planes, lines, ...) and of
    different types, or if points of one are off the analytic surface or curve of the other."""
    if _is_analytic(a):
        a, b = b, a
    if not _is_analytic(b):
        return True
    if _is_analytic(a) and type(_geometry(a)) is not type(_geometry(b)):
        return False
    return all(_distance(_geometry(b), point) <= tolerance for point in _points(a))


def _geometry(element):
    return element.Curve if element.ShapeType == "Edge" else element.Surface


def _is_analytic(element):
    return type(_geometry(element)).__name__ in ANALYTIC


def _distance(geometry, point):
    """Returns the distance of a point to a surface or a curve, continued beyond its ends."""
    place = geometry.parameter(point)
    return point.distanceToPoint(geometry.value(*(place if isinstance(place, tuple) else (place,))))


def _points(element):
    shares = (0.1, 0.5, 0.8)
    if element.ShapeType == "Edge":
        first, last = element.ParameterRange
        return [element.valueAt(first + s * (last - first)) for s in shares]
    u0, u1, v0, v1 = element.ParameterRange
    return [element.valueAt(u0 + s * (u1 - u0), v0 + t * (v1 - v0)) for s in shares for t in shares]
