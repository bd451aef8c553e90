// A view of the mesh that turns and cuts: it draws the outer faces of the tetrahedra on one side of a plane or, for a
// mesh of triangles alone, the triangles there. A cell is a tetrahedron or such a triangle.
'use strict';

const noNeighbour = -1;
// Corners of the face opposite each corner, turned outwards.
const faceCorners = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
const edgeCorners = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
const sideCorners = [[0, 1], [0, 2], [1, 2]];

async function inflate(text) {
  const packed = Uint8Array.from(atob(text.trim()), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

// Reads a mesh. Shapes: points 3 per point, relative to shown.centre; tets 4 per tet; patches 4 per face on a patch, three
// corners and the number of its tag in shown.face_tags; region, marks (1 collar, 2 thin, 8 odd and 16 even layers) 1 per
// tet.
async function readMesh(shown, text) {
  const data = await inflate(text), { points, tets, faces } = shown, end = 12 * points + 16 * tets + 16 * faces;
  const mesh = { points: new Float32Array(data, 0, 3 * points), tets: new Uint32Array(data, 12 * points, 4 * tets),
    patches: new Uint32Array(data, 12 * points + 16 * tets, 4 * faces),
    region: new Uint16Array(data, end, tets), marks: new Uint8Array(data, end + 2 * tets, tets) };
  mesh.neighbours = findNeighbours(mesh.tets);
  mesh.tagNumber = tagNumbers(mesh.patches);
  mesh.isSurface = tets === 0;
  mesh.smallest = Float32Array.from({ length: mesh.isSurface ? faces : tets }, (_, cell) => anglesOf(mesh, cell)[0]);
  return mesh;
}

// Reads a step of the run: a mesh with the segments of its curves (two points each) and its collars' balls (a centre and
// a radius each).
async function readStep(step) {
  const mesh = await readMesh(step, step.data), extras = await inflate(step.extras);
  mesh.lines = new Float32Array(extras, 0, 6 * step.segments);
  mesh.balls = new Float32Array(extras, 24 * step.segments, 4 * step.balls);
  return Object.assign(mesh, { title: `${step.stage}${step.detail && `: ${step.detail}`}`, complete: step.complete });
}

// Finds the neighbours of tets by a hash table of faces. A face is stored at the place of the first tet that has it.
function findNeighbours(tets) {
  const neighbours = new Int32Array(tets.length).fill(noNeighbour);
  let size = 1024;
  while (size < 2 * tets.length) size *= 2;
  const slots = new Int32Array(size).fill(-1), corners = new Uint32Array(3), others = new Uint32Array(3);
  const sorted = (face, into) => {
    const t = 4 * (face >> 2), [i, j, k] = faceCorners[face & 3];
    into[0] = tets[t + i]; into[1] = tets[t + j]; into[2] = tets[t + k];
    return into.sort();
  };
  for (let face = 0; face < tets.length; ++face) {
    const [a, b, c] = sorted(face, corners);
    let slot = (Math.imul(a, 73856093) ^ Math.imul(b, 19349663) ^ Math.imul(c, 83492791)) & (size - 1);
    for (; slots[slot] >= 0; slot = (slot + 1) & (size - 1)) {
      const other = sorted(slots[slot], others);
      if (other[0] !== a || other[1] !== b || other[2] !== c) continue;
      neighbours[face] = slots[slot] >> 2;
      neighbours[slots[slot]] = face >> 2;
      break;
    }
    if (slots[slot] < 0) slots[slot] = face;
  }
  return neighbours;
}

// Maps the sorted corners of each face to the number of its tag.
function tagNumbers(patches) {
  const numbers = new Map();
  for (let f = 0; f < patches.length; f += 4)
    numbers.set([patches[f], patches[f + 1], patches[f + 2]].sort((a, b) => a - b).join(), patches[f + 3]);
  return numbers;
}

// Returns the three points of a drawn face.
function pointsOfFace(mesh, face) {
  return mesh.isSurface ? [...mesh.patches.subarray(4 * face, 4 * face + 3)]
    : faceCorners[face & 3].map(i => mesh.tets[4 * (face >> 2) + i]);
}

// Returns the cell that a drawn face belongs to.
function cellOf(mesh, face) {
  return mesh.isSurface ? face : face >> 2;
}

// Returns the number of a drawn face's tag; undefined for a face that is on no patch.
function tagNumberOf(mesh, face) {
  if (mesh.isSurface) return mesh.patches[4 * face + 3];
  return mesh.tagNumber.get(pointsOfFace(mesh, face).sort((a, b) => a - b).join());
}

function pointsOfCell(mesh, cell) {
  return mesh.isSurface ? pointsOfFace(mesh, cell) : [...mesh.tets.subarray(4 * cell, 4 * cell + 4)];
}

function cornersOf(mesh, cell) {
  return pointsOfCell(mesh, cell).map(point => new THREE.Vector3().fromArray(mesh.points, 3 * point));
}

// Returns the smallest and the largest angle of a cell, in degrees; for a tetrahedron, those of its dihedral angles.
function anglesOf(mesh, cell) {
  const p = cornersOf(mesh, cell);
  if (!mesh.isSurface) return dihedralAngles(p);
  const angles = [0, 1, 2].map(i =>
    p[(i + 1) % 3].clone().sub(p[i]).angleTo(p[(i + 2) % 3].clone().sub(p[i])) * 180 / Math.PI);
  return [Math.min(...angles), Math.max(...angles)];
}

function dihedralAngles(p) {
  const normals = faceCorners.map(([i, j, k]) =>
    p[j].clone().sub(p[i]).cross(p[k].clone().sub(p[i])).normalize());
  const angles = edgeCorners.map(([i, j]) =>
    180 - Math.acos(Math.max(-1, Math.min(1, normals[i].dot(normals[j])))) * 180 / Math.PI);
  return [Math.min(...angles), Math.max(...angles)];
}

const angleColours = [[0, '#b2182b'], [5, '#d6604d'], [10, '#f4a582'], [20, '#fddbc7'], [30, '#d1e5f0'], [40, '#92c5de'], [50, '#4393c3']];
const regionColours = ['#7fa7c9', '#d9a05b', '#7fb685', '#c98ba6', '#b5a642', '#8f8fc6', '#c77b6b', '#6fb7b7'];
const markColours = { plain: '#c3cdd8', marked: '#d1495b', ripped: '#e3a72f' };
const background = 0xf4f6f8;
// A patch gets a label if at least this many of its pixels are visible in a small picture of this width.
const leastPixels = 6, smallWidth = 240;

// Returns a colour for a number. Neighbouring numbers get colours far apart: hues by the golden angle.
function faceColour(number) {
  return new THREE.Color().setHSL((0.58 + 0.381966 * number) % 1, 0.45, [0.68, 0.58, 0.76][number % 3]);
}

const layerColours = [[0, '#b2182b'], [0.1, '#ef8a62'], [0.3, '#fddbc7'], [0.6, '#d1e5f0'], [0.9, '#4393c3']];
const cellColours = { odd: '#e3a72f', even: '#f1d38c' };  // cells of layers, in cuts

// Colours faces by the share of the thickness that their layers reach in the mean, and cells inside by their layers.
function layerColour(mesh, face) {
  const number = tagNumberOf(mesh, face), marks = mesh.marks[face >> 2];
  if (number === undefined) return marks & 8 ? cellColours.odd : marks & 16 ? cellColours.even : markColours.plain;
  const share = mesh.layers.get(number);
  return share === undefined ? markColours.plain : layerColours.filter(([least]) => share >= least - 1e-6).pop()[1];
}

function layerLegend(mesh) {
  const shares = layerColours.map(([least, colour]) => [colour, `thickness from ${Math.round(100 * least)}%`]);
  return [...shares, [cellColours.odd, 'odd layers'], [cellColours.even, 'even layers'], [markColours.plain, 'others']];
}

// Returns the file's colour of a face; faces inside a region have the region's colour.
function fileColour(mesh, number, region) {
  return mesh.colours && (mesh.colours.faces[number] || mesh.colours.regions.get(region)) || markColours.plain;
}

function colourOf(mesh, face, by) {
  const tet = cellOf(mesh, face);
  if (by === 'face') {
    const number = tagNumberOf(mesh, face);
    return number === undefined ? markColours.plain : faceColour(number);
  }
  if (by === 'file') return fileColour(mesh, tagNumberOf(mesh, face), mesh.region[tet]);
  if (by === 'region') return regionColours[(mesh.region[tet] + regionColours.length - 1) % regionColours.length];
  if (by === 'angle') return angleColours.filter(([least]) => mesh.smallest[tet] >= least).pop()[1];
  if (by === 'layers') return layerColour(mesh, face);
  if (by === 'collar' && mesh.marks[tet] & 4) return markColours.ripped;
  return mesh.marks[tet] & (by === 'collar' ? 1 : 2) ? markColours.marked : markColours.plain;
}

// Lists the faces with each colour.
function fileLegend(mesh, shown, names) {
  const named = new Map();
  mesh.colours.faces.forEach((colour, number) => {
    const key = colour || markColours.plain;
    named.set(key, [...(named.get(key) || []), names.face(shown.face_tags[number])]);
  });
  return [...named].map(([colour, faces]) => [colour, faces.length > 4 ? `${faces.slice(0, 3).join(', ')} and ${faces.length - 3} more` : faces.join(', ')]);
}

function legend(mesh, shown, names, by) {
  if (by === 'file') return mesh.colours ? fileLegend(mesh, shown, names) : [];
  if (by === 'face')
    return shown.face_tags.map((tag, number) => [`#${faceColour(number).getHexString()}`, names.face(tag)]);
  if (by === 'angle') return angleColours.map(([least, colour]) => [colour, `from ${least}°`]);
  if (by === 'region')
    return [...new Set(mesh.region)].sort((a, b) => a - b)
      .map(r => [regionColours[(r + regionColours.length - 1) % regionColours.length], names.region(r)]);
  if (by === 'layers') return layerLegend(mesh);
  const ripped = by === 'collar' && mesh.marks.some(mark => mark & 4);
  if (ripped) return [[markColours.ripped, 'about to be ripped out'], [markColours.plain, 'others']];
  return [[markColours.marked, by === 'collar' ? 'in a collar' : 'thin'], [markColours.plain, 'others']];
}

// Returns three great circles of each ball, as the ends of segments.
function circlesOf(balls) {
  const ends = [], pieces = 24;
  for (let b = 0; b < balls.length; b += 4)
    for (let axis = 0; axis < 3; ++axis)
      for (let i = 0; i < 2 * pieces; ++i) {
        const turn = 2 * Math.PI * ((i + 1) >> 1) / pieces, end = [balls[b], balls[b + 1], balls[b + 2]];
        end[(axis + 1) % 3] += balls[b + 3] * Math.cos(turn);
        end[(axis + 2) % 3] += balls[b + 3] * Math.sin(turn);
        ends.push(...end);
      }
  return ends;
}

class View {
  constructor(shown, mesh, names, straightened) {
    this.shown = shown;
    this.mesh = mesh;
    this.names = names;
    document.querySelector('#colour option[value=file]').hidden = !mesh.colours;
    for (const kind of ['region', 'collar', 'thin'])
      document.querySelector(`#colour option[value=${kind}]`).hidden = mesh.isSurface;
    if (mesh.isSurface) document.querySelector('#colour option[value=angle]').textContent = 'smallest angle';
    document.querySelector('#colour option[value=layers]').hidden = mesh.layers.size === 0;
    this.canvas = document.getElementById('canvas');
    this.box = new THREE.Box3().setFromArray(mesh.points);
    this.diagonal = this.box.getSize(new THREE.Vector3()).length();
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.55));
    const lamp = new THREE.DirectionalLight(0xffffff, 0.6);
    lamp.position.set(0.4, 0.7, 1);
    this.camera.add(lamp);
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setClearColor(background);
    this.canvas.append(this.renderer.domElement);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    this.surface = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial(
      { vertexColors: THREE.VertexColors, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
        side: mesh.isSurface ? THREE.DoubleSide : THREE.FrontSide }));
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
      { color: 0x24323f, transparent: true, opacity: 0.45 }));
    this.mark = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
      { color: 0xff00aa, depthTest: false }));
    this.mark.renderOrder = 1;
    this.curves = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x0b5cad }));
    this.balls = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xd1495b }));
    this.scene.add(this.surface, this.lines, this.curves, this.balls, this.mark, this.straightened(straightened));
    this.numbered = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial(
      { vertexColors: THREE.VertexColors, side: this.surface.material.side }));
    this.numbers = new THREE.Scene();
    this.numbers.add(this.numbered);
    this.labels = shown.face_tags.map(tag => element('span', { hidden: '' }, names.face(tag)));
    document.getElementById('labels').append(...this.labels);
    this.readControls();
    this.resize();
    this.reset();
    this.controls.addEventListener('start', () => { this.whole = false; this.moves = true; this.placeLabels(); });
    this.controls.addEventListener('end', () => { this.moves = false; this.placeLabels(); });
    window.addEventListener('resize', () => { this.resize(); if (this.whole) this.reset(); });
  }

  // Offers a slider over the steps of the run, the last of which is the mesh. A step is read when it is first shown.
  offerSteps(packed) {
    if (packed.length === 0) return;
    const last = Object.assign(this.mesh, { title: 'the mesh', complete: this.shown.complete, lines: [], balls: [] });
    this.steps = [...packed.map(step => () => readStep(step)), () => last];
    const slider = document.getElementById('step');
    slider.max = packed.length;
    slider.value = packed.length;
    slider.addEventListener('input', () => this.showStep(Number(slider.value)));
    document.getElementById('trace').hidden = false;
    document.getElementById('stage').textContent = 'the mesh';
    document.body.dataset.steps = this.steps.length;
  }

  async showStep(number) {
    if (!this.steps || !this.steps[number]) return;
    this.wanted = number;
    const step = await this.steps[number]();
    if (this.wanted !== number) return;  // the slider has moved on
    this.steps[number] = () => step;
    this.mesh = Object.assign(step, { colours: this.mesh.colours, layers: this.mesh.layers });
    document.getElementById('step').value = number;
    document.getElementById('stage').textContent = `${number + 1} of ${this.steps.length}, ${step.title}`;
    document.getElementById('position').disabled = !step.complete;
    const draws = (lines, points) => {
      lines.geometry.dispose();
      lines.geometry = new THREE.BufferGeometry();
      lines.geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(points), 3));
    };
    draws(this.curves, step.lines);
    draws(this.balls, circlesOf(step.balls));
    document.body.dataset.balls = step.balls.length / 4;
    this.rebuild();
  }

  // Returns a dot for each node that stays off its face.
  straightened(nodes) {
    const geometry = new THREE.BufferGeometry();
    const at = nodes.flatMap(({ where }) => where.map((x, i) => x - this.shown.centre[i]));
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(at), 3));
    document.body.dataset.straightened = nodes.length;
    return new THREE.Points(geometry, new THREE.PointsMaterial({ color: 0x7a2bd0, size: 8, sizeAttenuation: false }));
  }

  readControls() {
    const control = id => document.getElementById(id);
    for (const id of ['colour', 'axis', 'position']) control(id).addEventListener('input', () => this.rebuild());
    control('names').addEventListener('input', () => this.draw());
    control('edges').addEventListener('input', () => { this.lines.visible = control('edges').checked; this.draw(); });
    control('reset').addEventListener('click', () => { control('axis').value = ''; this.reset(); });
    if (!this.shown.complete) control('position').disabled = true;  // the page only has cells around the middle planes
    let pressed = null;
    this.renderer.domElement.addEventListener('pointerdown', e => { pressed = [e.clientX, e.clientY]; });
    this.renderer.domElement.addEventListener('pointerup', e => {
      if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) this.select(e);
    });
  }

  reset() {
    const centre = this.box.getCenter(new THREE.Vector3());
    this.controls.target.copy(centre);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(centre).add(new THREE.Vector3(0.75, -1, 0.6));
    this.camera.lookAt(centre);
    this.camera.position.copy(centre).addScaledVector(this.backwards(), this.distanceToSeeAll(centre));
    this.whole = true;
    this.mark.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(0), 3));
    this.rebuild();
    this.controls.update();
    document.body.dataset.whole = this.seesAll() ? 'yes' : 'no';
  }

  backwards() {
    return new THREE.Vector3(0, 0, 1).applyQuaternion(this.camera.quaternion);
  }

  // Returns the camera's distance from the centre at which all points are in the picture, with a margin of a twentieth.
  distanceToSeeAll(centre) {
    const back = this.backwards(), right = new THREE.Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
    const up = new THREE.Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion);
    const tangent = Math.tan(this.camera.fov * Math.PI / 360) / 1.05, wide = tangent * this.camera.aspect;
    const p = new THREE.Vector3();
    let distance = 0;
    for (let i = 0; i < this.mesh.points.length; i += 3) {
      p.fromArray(this.mesh.points, i).sub(centre);
      distance = Math.max(distance, p.dot(back) + Math.max(Math.abs(p.dot(right)) / wide, Math.abs(p.dot(up)) / tangent));
    }
    return distance;
  }

  // Returns whether all points are in the picture.
  seesAll() {
    this.camera.updateMatrixWorld();
    const p = new THREE.Vector3();
    for (let i = 0; i < this.mesh.points.length; i += 3) {
      p.fromArray(this.mesh.points, i).project(this.camera);
      if (Math.max(Math.abs(p.x), Math.abs(p.y)) > 1) return false;
    }
    return true;
  }

  // Returns a function that tells whether a cell lies on the near side of the cut.
  kept() {
    const axis = 'xyz'.indexOf(document.getElementById('axis').value || '-');
    if (axis < 0) return () => true;
    const share = Number(document.getElementById('position').value);
    const low = this.box.min.getComponent(axis), at = low + share * (this.box.max.getComponent(axis) - low);
    return cell => {
      const of = pointsOfCell(this.mesh, cell);
      return of.reduce((sum, point) => sum + this.mesh.points[3 * point + axis], 0) <= at * of.length;
    };
  }

  // Returns the faces to draw: those of kept tetrahedra without a kept neighbour, or all kept triangles.
  outerFaces() {
    const { tets, neighbours, patches, isSurface } = this.mesh, inside = this.kept(), faces = [];
    const keep = Uint8Array.from({ length: (isSurface ? patches : tets).length / 4 }, (_, cell) => inside(cell) ? 1 : 0);
    for (let face = 0; face < tets.length; ++face)
      if (keep[face >> 2] && (neighbours[face] === noNeighbour || !keep[neighbours[face]])) faces.push(face);
    if (isSurface) keep.forEach((is, face) => { if (is) faces.push(face); });
    return faces;
  }

  rebuild() {
    const { points } = this.mesh, by = document.getElementById('colour').value, faces = this.outerFaces();
    const position = new Float32Array(9 * faces.length), colour = new Float32Array(9 * faces.length);
    const line = new Float32Array(18 * faces.length), rgb = new THREE.Color(), numbers = new Float32Array(9 * faces.length);
    faces.forEach((face, f) => {
      rgb.set(colourOf(this.mesh, face, by));
      const number = tagNumberOf(this.mesh, face);
      if (number !== undefined) this.numberColour(number).forEach((value, i) => {
        for (let k = 0; k < 3; ++k) numbers[9 * f + 3 * k + i] = value / 255;
      });
      pointsOfFace(this.mesh, face).forEach((point, k) => {
        const from = 3 * point;
        for (let i = 0; i < 3; ++i) {
          const value = points[from + i];
          position[9 * f + 3 * k + i] = value;
          line[18 * f + 6 * k + i] = value;
          line[18 * f + 6 * ((k + 2) % 3) + 3 + i] = value;
        }
        rgb.toArray(colour, 9 * f + 3 * k);
      });
    });
    this.faces = faces;
    this.surface.geometry.dispose();
    this.surface.geometry = new THREE.BufferGeometry();
    this.surface.geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    this.surface.geometry.setAttribute('color', new THREE.BufferAttribute(colour, 3));
    this.surface.geometry.computeVertexNormals();
    this.numbered.geometry.dispose();
    this.numbered.geometry = new THREE.BufferGeometry();
    this.numbered.geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    this.numbered.geometry.setAttribute('color', new THREE.BufferAttribute(numbers, 3));
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry();
    this.lines.geometry.setAttribute('position', new THREE.BufferAttribute(line, 3));
    document.body.dataset.triangles = faces.length;
    document.getElementById('legend').replaceChildren(...legend(this.mesh, this.shown, this.names, by).map(([c, text]) =>
      element('span', {}, element('i', { class: 'swatch', style: `background: ${c}` }), text)));
    this.draw();
  }

  // Marks a place (in the coordinates of the file) by its tet, if that is known, else by a cross.
  show(where, tet = null) {
    const at = new THREE.Vector3(...where.map((x, i) => x - this.shown.centre[i]));
    const lines = [];
    let reach = this.diagonal / 100;
    if (tet !== null) {
      const p = cornersOf(this.mesh, tet);
      for (const [i, j] of p.length === 3 ? sideCorners : edgeCorners) lines.push(...p[i].toArray(), ...p[j].toArray());
      reach = Math.max(...p.map(corner => corner.distanceTo(at)));
      this.tell(tet);
    } else {
      for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
        const step = new THREE.Vector3(...axis).multiplyScalar(reach);
        lines.push(...at.clone().sub(step).toArray(), ...at.clone().add(step).toArray());
      }
    }
    this.mark.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(lines), 3));
    this.mark.geometry.computeBoundingSphere();
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(at);
    this.camera.position.copy(at).addScaledVector(direction, 12 * reach);
    this.whole = false;
    this.controls.update();
    document.body.dataset.marked = lines.length / 6;
    this.draw();
  }

  select(event) {
    const box = this.renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
      1 - 2 * (event.clientY - box.top) / box.height), this.camera);
    const [hit] = ray.intersectObject(this.surface);
    if (hit) this.tell(cellOf(this.mesh, this.faces[hit.faceIndex]), this.faces[hit.faceIndex]);
  }

  // Shows the data of a cell, and which face was clicked.
  tell(tet, face = null) {
    const [smallest, largest] = anglesOf(this.mesh, tet), marks = this.mesh.marks[tet];
    const corners = cornersOf(this.mesh, tet).map(p => `(${p.toArray().map((x, i) => number(x + this.shown.centre[i])).join(', ')})`);
    const patch = face === null ? undefined : tagNumberOf(this.mesh, face);
    const on = patch === undefined ? '' : `${this.names.face(this.shown.face_tags[patch])}; `;
    document.getElementById('selected').textContent = `${on}${this.mesh.isSurface ? '' : `${this.names.region(this.mesh.region[tet])}, dihedral `}angles ${number(smallest)}° to ` +
      `${number(largest)}°${marks & 1 ? ', in a collar' : ''}${marks & 2 ? ', thin' : ''}; corners ${corners.join(' ')}`;
  }

  turn(degrees) {
    const { target } = this.controls, offset = this.camera.position.clone().sub(target);
    this.camera.position.copy(target).add(offset.applyAxisAngle(new THREE.Vector3(0, 0, 1), degrees * Math.PI / 180));
    this.camera.lookAt(target);
    if (this.whole) this.camera.position.copy(target).addScaledVector(this.backwards(), this.distanceToSeeAll(target));
    this.whole = false;
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.draw();
  }

  draw() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = distance / 200;
    this.camera.far = distance + 2 * this.diagonal;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
  }

  // Returns the number of a patch as a colour; no patch is black.
  numberColour(number) {
    return [(number + 1) >> 16 & 255, (number + 1) >> 8 & 255, (number + 1) & 255];
  }

  // Returns the pixels of each visible patch in a small picture whose colours are the patches' numbers.
  pixelsInSight() {
    const width = smallWidth, height = Math.max(1, Math.round(smallWidth / this.camera.aspect));
    const target = new THREE.WebGLRenderTarget(width, height), pixels = new Uint8Array(4 * width * height);
    this.renderer.setRenderTarget(target);
    this.renderer.setClearColor(0);
    this.renderer.render(this.numbers, this.camera);
    this.renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    this.renderer.setRenderTarget(null);
    this.renderer.setClearColor(background);
    target.dispose();
    const inSight = new Map();
    for (let i = 0; i < width * height; ++i) {
      const number = (pixels[4 * i] << 16 | pixels[4 * i + 1] << 8 | pixels[4 * i + 2]) - 1;
      if (number < 0) continue;
      if (!inSight.has(number)) inSight.set(number, []);
      inSight.get(number).push([(i % width + 0.5) / width, 1 - (Math.floor(i / width) + 0.5) / height]);
    }
    return inSight;
  }

  // Puts the name of each visible patch onto its pixel that is nearest to the middle of all its pixels. Hides the names
  // while the view moves.
  placeLabels() {
    const wanted = !this.moves && document.getElementById('names').checked && document.getElementById('colour').value === 'face';
    const inSight = wanted ? this.pixelsInSight() : new Map();
    this.labels.forEach((span, number) => {
      const pixels = inSight.get(number) || [];
      span.hidden = pixels.length < leastPixels;
      if (span.hidden) return;
      const middle = [0, 1].map(i => pixels.reduce((sum, p) => sum + p[i], 0) / pixels.length);
      const off = p => Math.hypot(p[0] - middle[0], p[1] - middle[1]);
      const [x, y] = pixels.reduce((best, p) => off(p) < off(best) ? p : best);
      span.style.left = `${100 * x}%`;
      span.style.top = `${100 * y}%`;
    });
  }
}
