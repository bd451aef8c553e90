"""The requested sizes on the surface of a part, by place. Works without the GUI.
The mesh follows them, but it may be finer in thin places and at sharp corners, which these sizes do not show."""

import dataclasses
import math

import numpy

from . import extent, inputs, size_presets

FINE = 1 / 60  # largest length of the triangles' edges, relative to the diagonal
DEFLECTION = 1 / 200  # relative to the diagonal
MOST = 20000  # number of triangles above which none is divided further
SAMPLES = 6  # samples of the curvature along each parameter of a face
POINTS = 500  # largest number of points on a face or an edge for measuring distances
GROWTH = 1  # growth of sizes away from finer faces and edges, unless the user gives another one


@dataclasses.dataclass
class Surface:
    """Separate triangles: the places of their corners, shape (3 n, 3), and for each corner the number of its face, 0
    for none."""

    places: numpy.ndarray
    faces: numpy.ndarray


def surface_of(part):
    """Returns the surface of an object, in triangles that are small enough to show sizes as colours of their
    corners."""
    mesh, diagonal = inputs.triangles_of(part), extent.diagonal(part)
    if mesh is not None:
        triangles = [(0, *mesh.Topology)]
    else:
        triangles = [(number, *face.tessellate(DEFLECTION * diagonal))
                     for number, face in enumerate(inputs.shape_of(part).Faces, 1)]
    places, faces = [numpy.zeros((0, 3, 3))], [numpy.zeros(0, dtype=int)]
    for number, points, corners in triangles:
        if corners:
            places.append(numpy.array([tuple(p) for p in points])[numpy.array(corners)])
            faces.append(numpy.full(len(corners), number))
    fine, numbers = subdivided(numpy.concatenate(places), numpy.concatenate(faces), FINE * diagonal)
    return Surface(fine.reshape(-1, 3), numpy.repeat(numbers, 3))


def subdivided(triangles, faces, longest):
    """Halves triangles at their longest edge while it is longer than `longest` and there are at most MOST triangles.
    Returns their corners, shape (n, 3, 3), and the numbers of their faces."""
    done = []
    while len(triangles):
        edges = numpy.linalg.norm(numpy.roll(triangles, -1, axis=1) - triangles, axis=2)
        is_long = edges.max(axis=1) > longest
        if sum(len(each) for each, _ in done) + len(triangles) > MOST:
            is_long[:] = False
        done.append((triangles[~is_long], faces[~is_long]))
        first = edges[is_long].argmax(axis=1)
        rows = numpy.arange(len(first))
        a, b, c = (triangles[is_long][rows, (first + k) % 3] for k in range(3))
        middle = (a + b) / 2
        triangles = numpy.concatenate([numpy.stack(each, axis=1) for each in ((a, middle, c), (middle, b, c))])
        faces = numpy.tile(faces[is_long], 2)
    return tuple(numpy.concatenate(each) for each in zip(*done)) if done else (triangles, faces)


def on(surface, part, settings):
    """Returns for each corner of a Surface the size that the Settings ask for, mm."""
    shape = inputs.shape_of(part)
    diagonal = extent.diagonal(part)
    places = surface.places
    sizes = numpy.full(len(places), settings.size or diagonal * size_presets.DEFAULT_PART_OF_DIAGONAL)
    if not shape.isNull():
        for number, size in settings.solid_sizes.items():
            inside = _on_solid(surface, shape, number)
            sizes[inside] = numpy.minimum(size, sizes[inside])
        growth = settings.gradation or GROWTH
        for kind, wanted in (("Face", settings.face_sizes), ("Edge", settings.edge_sizes)):
            for number, size in wanted.items():
                sizes = numpy.minimum(sizes, size + growth * _to_subshape(surface, shape, kind, number))
        if settings.elements_per_circle:
            sizes = numpy.minimum(sizes, _of_curvature(surface, shape, settings.elements_per_circle))
    for source in (settings.size_field or {}).get("sources", ()):
        beyond = numpy.maximum(0, _to_source(surface, shape, source) - source.get("within", 0))
        sizes = numpy.minimum(sizes, source["size"] + source["growth"] * beyond)
    return numpy.maximum(sizes, settings.size_min)


def _on_solid(surface, shape, number):
    """Returns which corners are on faces of the solid."""
    faces = [i for i, face in enumerate(shape.Faces, 1) if any(face.isSame(each)
                                                               for each in shape.Solids[number - 1].Faces)]
    return numpy.isin(surface.faces, faces)


def _to_source(surface, shape, source):
    """Returns distances from a source of a size field; 0 inside."""
    places = surface.places
    if "ball" in source:
        ball = source["ball"]
        return numpy.maximum(0, numpy.linalg.norm(places - ball["centre"], axis=1) - ball["radius"])
    if "box" in source:
        return _to_box(places, source["box"])
    if "cylinder" in source:
        return _to_cylinder(places, source["cylinder"])
    kind, numbers = ("Face", source["patches"]) if "patches" in source else ("Edge", source["curves"])
    return numpy.min([_to_subshape(surface, shape, kind, number) for number in numbers], axis=0)


def _to_box(places, box):
    if "min" in box:
        corner, edges = numpy.array(box["min"]), numpy.diag(numpy.subtract(box["max"], box["min"]))
    else:
        corner, edges = numpy.array(box["corner"]), numpy.array(box["edges"])
    lengths = numpy.linalg.norm(edges, axis=1)
    along = (places - corner) @ (edges / lengths[:, None]).T
    return numpy.linalg.norm(numpy.maximum(0, numpy.maximum(-along, along - lengths)), axis=1)


def _to_cylinder(places, cylinder):
    foot, axis = numpy.array(cylinder["from"]), numpy.subtract(cylinder["to"], cylinder["from"])
    height = numpy.linalg.norm(axis)
    along = (places - foot) @ axis / height
    across = numpy.linalg.norm(places - foot - along[:, None] * axis / height, axis=1) - cylinder["radius"]
    return numpy.hypot(numpy.maximum(0, numpy.maximum(-along, along - height)), numpy.maximum(0, across))


def _to_subshape(surface, shape, kind, number):
    """Returns distances from a face or an edge; 0 on the face."""
    if kind == "Face":
        its = surface.faces == number
        distances = _to_points(surface.places, numpy.unique(surface.places[its], axis=0))
        distances[its] = 0
        return distances
    edge = shape.Edges[number - 1]
    count = int(min(POINTS, max(3, edge.Length / (FINE * shape.BoundBox.DiagonalLength) * 4)))
    return _to_points(surface.places, numpy.array([tuple(p) for p in edge.discretize(count)]))


def _to_points(places, points):
    """Returns for each place the distance from the nearest point. If there are many points, uses at most POINTS of
    them. Works in blocks to bound memory."""
    points = points[:: max(1, math.ceil(len(points) / POINTS))]
    if not len(points):
        return numpy.full(len(places), numpy.inf)
    unique, where = numpy.unique(places, axis=0, return_inverse=True)
    squares = (points**2).sum(axis=1)
    nearest = [(squares - 2 * part @ points.T).min(axis=1) + (part**2).sum(axis=1)
               for part in numpy.array_split(unique, 1 + len(unique) // 2000)]
    return numpy.sqrt(numpy.maximum(0, numpy.concatenate(nearest)))[where.ravel()]


def _of_curvature(surface, shape, count):
    """Returns for each corner of the surface the size for `count` elements on a full circle; inf on planes. The
    circle's radius is the smallest radius of curvature at the sample of the corner's face that is nearest to the
    corner."""
    sizes = numpy.full(len(surface.places), numpy.inf)
    for number, face in enumerate(shape.Faces, 1):
        if type(face.Surface).__name__ == "Plane":
            continue
        its = surface.faces == number
        parameters = list(_parameters(face))
        bends = numpy.array([max(map(abs, face.curvatureAt(*each))) for each in parameters])
        points = numpy.array([tuple(face.valueAt(*each)) for each in parameters])
        nearest = ((surface.places[its][:, None, :] - points) ** 2).sum(axis=2).argmin(axis=1)
        with numpy.errstate(divide="ignore"):
            sizes[its] = (2 * math.pi / count / bends)[nearest]
    return sizes


def _parameters(face):
    """Yields the parameters of places on a face, away from the ends of its parameter range, at which some surfaces have
    no curvature."""
    u0, u1, v0, v1 = face.ParameterRange
    for i in range(SAMPLES):
        for j in range(SAMPLES):
            yield u0 + (u1 - u0) * (i + 0.5) / SAMPLES, v0 + (v1 - v0) * (j + 0.5) / SAMPLES
