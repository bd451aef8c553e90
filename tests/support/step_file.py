"""STEP files of boxes (AP214) with names of products and solids and with colours, written line by line."""

QUADS = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]  # outward


class StepFile:
    """Writes a STEP file. Solids are numbered in the order of their products, and faces in the order of the
    solids, six each: -x, +x, -y, +y, -z, +z."""

    def __init__(self):
        self._lines = []
        unit = self._complex("GEOMETRIC_REPRESENTATION_CONTEXT(3)", "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2,#3,#4))",
                             "REPRESENTATION_CONTEXT('','')")
        self._complex("LENGTH_UNIT()", "NAMED_UNIT(*)", "SI_UNIT(.MILLI.,.METRE.)")
        self._complex("NAMED_UNIT(*)", "PLANE_ANGLE_UNIT()", "SI_UNIT($,.RADIAN.)")
        self._complex("NAMED_UNIT(*)", "SI_UNIT($,.STERADIAN.)", "SOLID_ANGLE_UNIT()")
        self._unit = unit
        application = self._add("APPLICATION_CONTEXT('automotive design')")
        self._product_context = self._add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
        self._definition_context = self._add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
        self._styles = []

    def product(self, name, *solids):
        """Adds a product. Returns it for assemblies. solids: results of `box`."""
        axes = self._axes((0, 0, 0))
        return (*self._product(name, "ADVANCED_BREP_SHAPE_REPRESENTATION", [axes, *solids]), axes)

    def assembly(self, name, *instances):
        """Adds an assembly. instances: (product, place)."""
        axes = self._axes((0, 0, 0))
        places = [self._axes(place) for _, place in instances]
        definition, shape = self._product(name, "SHAPE_REPRESENTATION", [axes, *places])
        for number, ((part, part_shape, part_axes), _) in enumerate(instances):
            usage = self._add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number}','','',{definition},{part},$)")
            of_usage = self._add(f"PRODUCT_DEFINITION_SHAPE('','',{usage})")
            moved = self._add(f"ITEM_DEFINED_TRANSFORMATION('','',{part_axes},{places[number]})")
            related = self._complex(f"REPRESENTATION_RELATIONSHIP('','',{part_shape},{shape})",
                                    f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({moved})",
                                    "SHAPE_REPRESENTATION_RELATIONSHIP()")
            self._add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({related},{of_usage})")
        return definition, shape, axes

    def box(self, low, high, name="", colour=None, face_colours=None):
        """Adds a box. colour: (r, g, b), from 0 to 1; face_colours: {number among the six: colour}."""
        points = [tuple((low, high)[k >> axis & 1][axis] for axis in range(3)) for k in range(8)]
        vertices = [self._add(f"VERTEX_POINT('',{self._point(p)})") for p in points]
        edges = {}
        faces = [self._face(quad, points, vertices, edges) for quad in QUADS]
        shell = self._add(f"CLOSED_SHELL('',({','.join(faces)}))")
        solid = self._add(f"MANIFOLD_SOLID_BREP('{name}',{shell})")
        for item, wanted in [(solid, colour), *((faces[place], each) for place, each in (face_colours or {}).items())]:
            if wanted is not None:
                self._style(item, wanted)
        return solid

    def write(self, path):
        if self._styles:
            self._add(
                f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({','.join(self._styles)}),{self._unit})")
        header = ["ISO-10303-21;", "HEADER;", "FILE_DESCRIPTION((''),'2;1');", "FILE_NAME('','',(''),(''),'','','');",
                  "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));", "ENDSEC;", "DATA;"]
        path.write_bytes("\n".join([*header, *self._lines, "ENDSEC;",
                         "END-ISO-10303-21;", ""]).encode("utf-8", "surrogateescape"))
        return path

    def _add(self, text):
        self._lines.append(f"#{len(self._lines) + 1}={text};")
        return f"#{len(self._lines)}"

    def _complex(self, *parts):
        return self._add(f"({' '.join(parts)})")

    def _product(self, name, kind, items):
        product = self._add(f"PRODUCT('{name}','{name}','',({self._product_context}))")
        formation = self._add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        definition = self._add(f"PRODUCT_DEFINITION('design','',{formation},{self._definition_context})")
        of_definition = self._add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        shape = self._add(f"{kind}('',({','.join(items)}),{self._unit})")
        self._add(f"SHAPE_DEFINITION_REPRESENTATION({of_definition},{shape})")
        return definition, shape

    def _point(self, p):
        return self._add(f"CARTESIAN_POINT('',({','.join(repr(float(x)) for x in p)}))")

    def _direction(self, d):
        return self._add(f"DIRECTION('',({','.join(repr(float(x)) for x in d)}))")

    def _axes(self, origin, normal=(0, 0, 1), along=(1, 0, 0)):
        return self._add(
            f"AXIS2_PLACEMENT_3D('',{self._point(origin)},{self._direction(normal)},{self._direction(along)})")

    def _edge(self, a, b, points, vertices):
        along = [q - p for p, q in zip(points[a], points[b])]
        length = max(map(abs, along))
        vector = self._add(f"VECTOR('',{self._direction([x / length for x in along])},1.)")
        line = self._add(f"LINE('',{self._point(points[a])},{vector})")
        return self._add(f"EDGE_CURVE('',{vertices[a]},{vertices[b]},{line},.T.)")

    def _face(self, quad, points, vertices, edges):
        loop = []
        for a, b in zip(quad, quad[1:] + quad[:1]):
            key = min(a, b), max(a, b)
            if key not in edges:
                edges[key] = self._edge(*key, points, vertices)
            loop.append(self._add(f"ORIENTED_EDGE('',*,*,{edges[key]},.{'TF'[a > b]}.)"))
        bound = self._add(f"FACE_OUTER_BOUND('',{self._add(f'''EDGE_LOOP('',({','.join(loop)}))''')},.T.)")
        axis = next(i for i in range(3) if len({points[k][i] for k in quad}) == 1)
        outward = 1 if points[quad[0]][axis] > points[7 - quad[0]][axis] else -1
        normal = [outward * (i == axis) for i in range(3)]
        along = [int(i == (axis + 1) % 3) for i in range(3)]
        plane = self._add(f"PLANE('',{self._axes(points[quad[0]], normal, along)})")
        return self._add(f"ADVANCED_FACE('',({bound}),{plane},.T.)")

    def _style(self, item, colour):
        of_colour = self._add(
            f"FILL_AREA_STYLE_COLOUR('',{self._add(f'''COLOUR_RGB('',{','.join(repr(float(c)) for c in colour)})''')})")
        fill = self._add(f"SURFACE_STYLE_FILL_AREA({self._add(f'''FILL_AREA_STYLE('',({of_colour}))''')})")
        usage = self._add(f"SURFACE_STYLE_USAGE(.BOTH.,{self._add(f'''SURFACE_SIDE_STYLE('',({fill}))''')})")
        assigned = self._add(f"PRESENTATION_STYLE_ASSIGNMENT(({usage}))")
        self._styles.append(self._add(f"STYLED_ITEM('',({assigned}),{item})"))
