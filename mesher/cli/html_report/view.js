// A view of the mesh that turns and cuts: of the tetrahedra on one side of a plane the faces that nothing hides.
'use strict';

const noNeighbour = -1;
// Corners of the face opposite each corner, turned outwards.
const faceCorners = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
const edgeCorners = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

async function inflate(text) {
  const packed = Uint8Array.from(atob(text.trim()), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

// Shapes: points 3 per point, relative to shown.centre; tets 4 per tet; region, marks (1 collar, 2 thin) 1 per tet.
async function readMesh(shown, text) {
  const data = await inflate(text), { points, tets } = shown;
  const mesh = { points: new Float32Array(data, 0, 3 * points), tets: new Uint32Array(data, 12 * points, 4 * tets),
    region: new Uint16Array(data, 12 * points + 16 * tets, tets), marks: new Uint8Array(data, 12 * points + 18 * tets, tets) };
  mesh.neighbours = findNeighbours(mesh.tets);
  mesh.smallest = Float32Array.from({ length: tets }, (_, t) => dihedralAngles(mesh, t)[0]);
  return mesh;
}

// By a hash table of faces, each in the place of the first tet that has it.
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

function cornersOf(mesh, tet) {
  return [0, 1, 2, 3].map(i => new THREE.Vector3().fromArray(mesh.points, 3 * mesh.tets[4 * tet + i]));
}

// The smallest and the largest, in degrees.
function dihedralAngles(mesh, tet) {
  const p = cornersOf(mesh, tet);
  const normals = faceCorners.map(([i, j, k]) =>
    p[j].clone().sub(p[i]).cross(p[k].clone().sub(p[i])).normalize());
  const angles = edgeCorners.map(([i, j]) =>
    180 - Math.acos(Math.max(-1, Math.min(1, normals[i].dot(normals[j])))) * 180 / Math.PI);
  return [Math.min(...angles), Math.max(...angles)];
}

const angleColours = [[0, '#b2182b'], [5, '#d6604d'], [10, '#f4a582'], [20, '#fddbc7'], [30, '#d1e5f0'], [40, '#92c5de'], [50, '#4393c3']];
const regionColours = ['#7fa7c9', '#d9a05b', '#7fb685', '#c98ba6', '#b5a642', '#8f8fc6', '#c77b6b', '#6fb7b7'];
const markColours = { plain: '#c3cdd8', marked: '#d1495b' };

function colourOf(mesh, tet, by) {
  if (by === 'region') return regionColours[(mesh.region[tet] + regionColours.length - 1) % regionColours.length];
  if (by === 'angle') return angleColours.filter(([least]) => mesh.smallest[tet] >= least).pop()[1];
  return mesh.marks[tet] & (by === 'collar' ? 1 : 2) ? markColours.marked : markColours.plain;
}

function legend(mesh, by) {
  if (by === 'angle') return angleColours.map(([least, colour]) => [colour, `from ${least}°`]);
  if (by === 'region')
    return [...new Set(mesh.region)].sort((a, b) => a - b).slice(0, 12).map(r => [regionColours[(r + regionColours.length - 1) % regionColours.length], `region ${r}`]);
  return [[markColours.marked, by === 'collar' ? 'in a collar' : 'thin'], [markColours.plain, 'others']];
}

class View {
  constructor(shown, mesh) {
    this.shown = shown;
    this.mesh = mesh;
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
    this.renderer.setClearColor(0xf4f6f8);
    this.canvas.append(this.renderer.domElement);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    this.surface = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial(
      { vertexColors: THREE.VertexColors, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
      { color: 0x24323f, transparent: true, opacity: 0.45 }));
    this.mark = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
      { color: 0xff00aa, depthTest: false }));
    this.mark.renderOrder = 1;
    this.scene.add(this.surface, this.lines, this.mark);
    this.readControls();
    this.reset();
    window.addEventListener('resize', () => this.resize());
    this.resize();
  }

  readControls() {
    const control = id => document.getElementById(id);
    for (const id of ['colour', 'axis', 'position']) control(id).addEventListener('input', () => this.rebuild());
    control('edges').addEventListener('input', () => { this.lines.visible = control('edges').checked; this.draw(); });
    control('reset').addEventListener('click', () => { control('axis').value = ''; this.reset(); });
    if (!this.shown.complete) control('position').disabled = true;  // cells are there around the middle planes only
    let pressed = null;
    this.renderer.domElement.addEventListener('pointerdown', e => { pressed = [e.clientX, e.clientY]; });
    this.renderer.domElement.addEventListener('pointerup', e => {
      if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) this.select(e);
    });
  }

  reset() {
    const centre = this.box.getCenter(new THREE.Vector3());
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(new THREE.Vector3(0.75, -1, 0.6).normalize(), 1.45 * this.diagonal);
    this.camera.up.set(0, 0, 1);
    this.mark.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(0), 3));
    this.rebuild();
    this.controls.update();
  }

  // Which tets lie on the near side of the cut?
  kept() {
    const axis = 'xyz'.indexOf(document.getElementById('axis').value || '-');
    if (axis < 0) return () => true;
    const share = Number(document.getElementById('position').value);
    const { points, tets } = this.mesh, low = this.box.min.getComponent(axis), high = this.box.max.getComponent(axis);
    const at = 4 * (low + share * (high - low));
    return t => [0, 1, 2, 3].reduce((sum, i) => sum + points[3 * tets[4 * t + i] + axis], 0) <= at;
  }

  rebuild() {
    const { points, tets, neighbours } = this.mesh, by = document.getElementById('colour').value;
    const inside = this.kept(), count = tets.length / 4;
    const keep = Uint8Array.from({ length: count }, (_, t) => inside(t) ? 1 : 0);
    const faces = [];
    for (let face = 0; face < tets.length; ++face)
      if (keep[face >> 2] && (neighbours[face] === noNeighbour || !keep[neighbours[face]])) faces.push(face);
    const position = new Float32Array(9 * faces.length), colour = new Float32Array(9 * faces.length);
    const line = new Float32Array(18 * faces.length), rgb = new THREE.Color();
    faces.forEach((face, f) => {
      const t = face >> 2;
      rgb.set(colourOf(this.mesh, t, by));
      faceCorners[face & 3].forEach((corner, k) => {
        const from = 3 * tets[4 * t + corner];
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
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry();
    this.lines.geometry.setAttribute('position', new THREE.BufferAttribute(line, 3));
    document.body.dataset.triangles = faces.length;
    document.getElementById('legend').replaceChildren(...legend(this.mesh, by).flatMap(([c, text]) =>
      [element('span', { class: 'swatch', style: `background: ${c}` }), text]));
    this.draw();
  }

  // What is at this place (in the coordinates of the file): the tet, if it is known, else a cross.
  show(where, tet = null) {
    const at = new THREE.Vector3(...where.map((x, i) => x - this.shown.centre[i]));
    const lines = [];
    let reach = this.diagonal / 100;
    if (tet !== null) {
      const p = cornersOf(this.mesh, tet);
      for (const [i, j] of edgeCorners) lines.push(...p[i].toArray(), ...p[j].toArray());
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
    this.controls.update();
    document.body.dataset.marked = lines.length / 6;
    this.draw();
  }

  select(event) {
    const box = this.renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
      1 - 2 * (event.clientY - box.top) / box.height), this.camera);
    const [hit] = ray.intersectObject(this.surface);
    if (hit) this.tell(this.faces[hit.faceIndex] >> 2);
  }

  tell(tet) {
    const [smallest, largest] = dihedralAngles(this.mesh, tet), marks = this.mesh.marks[tet];
    const corners = cornersOf(this.mesh, tet).map(p => `(${p.toArray().map((x, i) => number(x + this.shown.centre[i])).join(', ')})`);
    document.getElementById('selected').textContent = `Region ${this.mesh.region[tet]}, dihedral angles ${number(smallest)}° to ` +
      `${number(largest)}°${marks & 1 ? ', in a collar' : ''}${marks & 2 ? ', thin' : ''}; corners ${corners.join(' ')}`;
  }

  turn(degrees) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new THREE.Vector3(0, 0, 1), degrees * Math.PI / 180);
    this.camera.position.copy(this.controls.target).add(offset);
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
  }
}
