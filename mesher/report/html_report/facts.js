// The text of the page: what was asked for, made, found and repaired, from the JSON of the run.
'use strict';

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    name.startsWith('on') ? made.addEventListener(name.slice(2), value) : made.setAttribute(name, value);
  made.append(...children);
  return made;
}

function number(value) {
  if (value === null || value === undefined) return '–';
  return Number.isInteger(value) ? value.toLocaleString('en') : String(Number(value.toPrecision(4)));
}

// Returns a volume as text, with enough digits to compare.
function volume(value) {
  return value.toLocaleString('en', { maximumSignificantDigits: 7 });
}

function table(rows) {
  return element('table', {}, ...rows.map(([name, value]) =>
    element('tr', {}, element('th', {}, name), element('td', {}, value))));
}

// Returns the names of regions and faces for the whole page: those given, else those of CAD files, else numbers.
function namesOf(report) {
  const cad = report.inputs.some(path => /\.(step|stp|iges|igs|brep|brp)$/i.test(path));
  const regions = new Map(report.complex.regions.map(r => [r.region, r.name || r.input.split('/').pop() || `region ${r.tag}`]));
  const all = [...regions.values()];
  for (const { region, tag } of report.complex.regions)  // several regions may come from one file
    if (all.filter(name => name === regions.get(region)).length > 1) regions.set(region, `${regions.get(region)} ${tag}`);
  const faces = new Map(report.complex.patch_list.map(p => [p.tag, p.name || (cad ? `Face${p.tag}` : `patch ${p.tag}`)]));
  return { region: number => regions.get(number) || `region ${number}`, face: tag => faces.get(tag) || `patch ${tag}` };
}

// Returns the colours that the file gives: of faces by number in face_tags, of regions by number. Undefined without
// colours.
function coloursOf(report, shown) {
  const faces = new Map(report.complex.patch_list.map(p => [p.tag, p.colour]));
  const regions = new Map(report.complex.regions.map(r => [r.region, r.colour]));
  const found = { faces: shown.face_tags.map(tag => faces.get(tag)), regions };
  return [...found.faces, ...regions.values()].some(Boolean) ? found : undefined;
}

// Returns the share of the thickness that layers reach in the mean, by number in face_tags.
function layersOf(report, shown) {
  const numbers = new Map(shown.face_tags.map((tag, number) => [tag, number]));
  return new Map((report.layers?.patches ?? []).map(p => [numbers.get(p.tag), p.thickness_mean / p.thickness_asked]));
}

function place(where, show) {
  const text = `(${where.map(number).join(', ')})`;
  return element('a', { class: 'place', onclick: () => show(where) }, text);
}

// Texts for the page, each with the certificate's names of the guarantees that it describes.
const guarantees = [
  ['Conformity: corners, edges and faces of the input are in the mesh',
    ['conforming', 'watertight', 'curve_cover', 'curve_distance', 'patch_area', 'patch_border', 'patch_distance', 'patch_manifold',
      'patch_orientation', 'patch_plane', 'vertex_feature', 'vertex_present', 'listed_edges', 'listed_faces']],
  ['Regions: each tetrahedron lies in one, and volumes are kept', ['region_volume', 'volume_kept', 'thickness_kept', 'region_tag', 'positive_volume', 'distinct_tets']],
  ['Tags: each face and edge has the tag of its face or edge of the input', ['curve_tag', 'patch_tag', 'patch_regions', 'face_regions']],
  ['Shape: circumradius over shortest edge is bounded', ['radius_edge']],
  ['Triangles have no small or large angle', ['triangle_angles']],
  ['Faces of solids point outwards, those of open surfaces are oriented alike', ['shell_orientation']],
  ['Thin tetrahedra have no small or large angle', ['thin_angles']],
  ['Collars have no large angle',
    ['collar_cells', 'collar_centre', 'collar_dihedral', 'collar_disjoint', 'collar_gap']],
  ['Second order: no element is inverted', ['mid_nodes', 'mid_node_distance', 'positive_jacobian']],
  ['Boundary layers: cells are valid and conform, volumes are kept, the tetrahedra beside them keep their bounds',
    ['layer_arrays', 'layer_jacobian', 'layer_conforming', 'layer_sides', 'layer_mid_nodes', 'layer_volume', 'layer_walls',
      'core_angles']],
];

const ofTriangles = ['triangle_angles', 'shell_orientation'], ofTets = ['region_volume', 'radius_edge', 'thin_angles', 'collar_cells'];

// Returns whether the run gives the guarantees with these names.
function given(report, names) {
  return (report.options.order === 2 || !names.includes('mid_nodes')) &&
    (report.layers || !names.includes('layer_jacobian')) &&
    !names.some(name => (report.check.triangles ? ofTets : ofTriangles).includes(name));
}

function guaranteeList(report, show) {
  const findings = report.check.findings, known = new Set(guarantees.flatMap(([, names]) => names));
  const lines = guarantees.filter(([, names]) => given(report, names))
    .map(([text, names]) => [text, findings.filter(f => names.includes(f.guarantee))]);
  const others = findings.filter(f => !known.has(f.guarantee));
  if (others.length > 0) lines.push(['The file is sound', others]);
  return element('ul', { class: 'plain' }, ...lines.map(([text, broken]) =>
    element('li', { class: broken.length > 0 ? 'bad' : 'good' }, (broken.length > 0 ? '✗ ' : '✓ ') + text,
      element('ul', {}, ...broken.slice(0, 50).map(f => element('li', {}, f.message + ' ', place(f.where, show)))))));
}

function histogram(title, { bin_width: width, tets, triangles: counts = tets }, unit, of = '') {
  const svg = 'http://www.w3.org/2000/svg', w = 420, h = 90, left = 4, bar = (w - 2 * left) / counts.length;
  const draw = (tag, attributes, text = '') => {
    const made = document.createElementNS(svg, tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.textContent = text;
    return made;
  };
  const chart = draw('svg', { viewBox: `0 0 ${w} ${h + 16}`, role: 'img', 'aria-label': title });
  const most = Math.max(1, ...counts);
  counts.forEach((count, i) => {
    // The bar of a single element must be visible, too.
    const height = count > 0 ? Math.max(1.5, h * count / most) : 0;
    const last = i + 1 === counts.length && unit === '';
    const rect = draw('rect', { x: left + i * bar, y: h - height, width: bar - 1, height, fill: '#4c86c6' });
    rect.append(draw('title', {}, `${number(i * width)}${last ? ' and more' : `–${number((i + 1) * width)}`}${unit}: ${number(count)}${of}`));
    chart.append(rect);
    if (i % 3 === 0) chart.append(draw('text', { x: left + i * bar, y: h + 13 }, `${number(i * width)}${unit}`));
  });
  return element('div', {}, element('h2', {}, title), chart);
}

function layers(report, names, show) {
  const made = report.layers;
  if (!made) return [];
  const whole = made.patches.reduce((sum, p) => sum + p.area, 0), percent = part => `${number(Number(part.toFixed(1)))} %`;
  const tenths = made.patches.reduce((sums, p) => sums.map((sum, i) => sum + p.area_by_tenth_of_thickness[i]), Array(10).fill(0));
  const most = 20, ordered = [...made.patches].sort((a, b) => a.covered / a.area - b.covered / b.area);
  const rows = ordered.slice(0, most).map(p => [names.face(p.tag),
    `${percent(100 * p.covered / p.area)} covered, mean thickness ${number(p.thickness_mean)} of ${number(p.thickness_asked)} asked for`]);
  const more = ordered.length > most ? [['Others', `${number(ordered.length - most)} faces, covered better`]] : [];
  const lower = made.reductions.map(r => element('li', {},
    `${number(r.nodes)} nodes, down to ${percent(100 * r.smallest_share)}: ${r.why}, the lowest at `, place(r.where, show)));
  return [element('h2', {}, 'Boundary layers'),
    table([['Covered', percent(100 * made.coverage)], ['Largest step between neighbours', number(made.largest_step)],
      ['Cells', `${number(made.prisms)} prisms, ${number(made.pyramids)} pyramids, ${number(made.tets)} tetrahedra`], ...rows, ...more]),
    ...(lower.length > 0 ? [element('p', {}, 'Lower than asked for:'), element('ul', {}, ...lower)] : []),
    histogram('Area of the walls, by the share of the thickness reached',
      { bin_width: 10, tets: tenths.map(area => Number((100 * area / whole).toPrecision(3))) }, '%', ' % of the area')];
}

function repairs(report, show) {
  const repair = report.repair;
  if (!repair || !repair.repaired) return [];
  const lines = repair.messages.map(message => element('li', {}, message));
  for (const [name, text] of [['cut', 'cut'], ['collapsed', 'collapsed'], ['stitched', 'stitched'], ['merged', 'merged'],
    ['repeated', 'repeated'], ['turned', 'turned']]) {
    const where = repair[name].where;
    if (where.length === 0) continue;
    const places = where.slice(0, 8).flatMap(p => [' ', place(p, show)]);
    lines.push(element('li', {}, `places ${text}:`, ...places));
  }
  for (const hole of repair.filled) lines.push(element('li', {}, `hole filled, tag ${hole.tag}: `, place(hole.where, show)));
  return [element('h2', {}, 'Repaired'), element('ul', {}, ...lines)];
}

function worst(shown, show) {
  const line = ({ tet, smallest, largest, where }) => element('li', {},
    `${number(smallest)}° to ${number(largest)}° at `,
    element('a', { class: 'place', onclick: () => show(where, tet) }, `(${where.map(number).join(', ')})`));
  return [element('h2', {}, 'Worst elements'), element('ul', {}, ...shown.worst.map(line))];
}

function straightened(report, names, show) {
  const nodes = report.second_order ? report.second_order.straightened : [];
  if (nodes.length === 0) return [];
  const line = ({ where, distance, dimension, tag }) => element('li', {},
    `${dimension === 2 ? names.face(tag) : `edge ${tag}`}: ${number(distance)} away, at `, place(where, show));
  return [element('h2', {}, 'Straightened nodes'),
    element('p', {}, `${number(nodes.length)} mid-edge nodes stay off their smooth face or edge, as an element would be ` +
      'inverted otherwise. The view marks them in violet.'),
    element('ul', {}, ...nodes.slice(0, 50).map(line))];
}

// Returns a text on tetrahedra whose small angles are due to short edges of the input.
function forced(check) {
  return check.forced_tets > 0
    ? ` (${number(check.forced_tets)} of them smaller than asked for, in narrow places of the input)` : '';
}

// Returns a text on the largest ratio of each kind of tetrahedra; the histogram of all tetrahedra ends at the largest
// of these.
function ratios(mesh) {
  const kinds = [['', mesh.max_radius_edge], [' (thin tetrahedra)', mesh.max_thin_radius_edge],
    [' (collars)', mesh.max_collar_radius_edge]];
  return kinds.filter(([, value]) => value !== 0)  // 0: there is no tetrahedron of this kind
    .map(([text, value]) => `at most ${value === null ? 'infinite' : number(value)}${text}`).join(', ');
}

function kept(check, region) {
  const found = check.kept.region_volumes.find(each => each.number === region);
  return found ? ` (${found.percent < 0 ? '' : '+'}${found.percent.toFixed(2)} % of the input's ${volume(found.input)})` : '';
}

function histogramsOf({ mesh, check }) {
  if (check.triangles)
    return [histogram('Smallest angle of each triangle', check.triangles.histograms.min_angle, '°'),
      histogram('Largest angle', check.triangles.histograms.max_angle, '°')];
  return [histogram('Smallest dihedral angle of each tetrahedron', mesh.histograms.min_dihedral, '°'),
    histogram('Largest dihedral angle', mesh.histograms.max_dihedral, '°'),
    histogram('Circumradius / shortest edge', mesh.histograms.radius_edge, '')];
}

// Returns the rows of the table on the mesh.
function shapesOf({ mesh, check }) {
  if (check.triangles)
    return [['Angles', `${number(check.triangles.min_angle)}° to ${number(check.triangles.max_angle)}°`],
      ['Triangles at sharp corners of the input', number(check.triangles.at_sharp_corners)]];
  return [['Dihedral angles', `${number(mesh.min_dihedral)}° to ${number(mesh.max_dihedral)}°` + forced(check)],
    ['Circumradius / shortest edge', ratios(mesh)],
    ['Thin, in collars', `${number(check.thin_tets)}, ${number(check.collar_tets)}`]];
}

function countsOf({ mesh, check }) {
  const nodes = ['Nodes', number(mesh.points)];
  return check.triangles ? [['Triangles', number(mesh.faces)], nodes, ['Edges on curves', number(mesh.edges)]]
    : [['Tetrahedra', number(mesh.tets)], nodes, ['Boundary triangles', number(mesh.faces)]];
}

function describe(report, shown, names, show) {
  const { mesh, check, complex, options } = report, name = report.inputs.map(path => path.split('/').pop()).join(', ');
  document.title = `${name}: mesh report`;
  document.getElementById('title').textContent = name;
  const verdict = document.getElementById('verdict');
  verdict.className = report.guarantees_hold ? 'good' : 'bad';
  verdict.textContent = report.guarantees_hold ? 'Every guarantee holds' :
    `A guarantee is missed: ${number(check.findings_total)} findings`;
  const diagonal = complex.diagonal, size = options.size ?? diagonal / 20;
  const changed = ['region_size', 'patch_size', 'curve_size'].flatMap(kind =>
    Object.entries(options[kind]).map(([tag, value]) => [`Size of ${kind.split('_')[0]} ${tag}`, number(value)]));
  const regions = complex.regions.filter(r => r.region in mesh.region_volumes).map(r => [`Volume of ${names.region(r.region)}`, volume(mesh.region_volumes[r.region]) + kept(check, r.region)]);
  const periodic = (report.periodic?.pairs ?? []).map(p => [`Periodic ${p.text}`,
    `${number(p.nodes)} nodes, ${number(p.triangles)} triangles map onto their images; largest gap ${number(p.largest_gap)}`]);
  const warnings = [...report.warnings, ...complex.warnings.map(w => w.message), ...check.warnings, ...report.notes, ...check.notes];
  document.getElementById('facts').append(
    element('h2', {}, 'Asked for'),
    table([['Size', number(size) + (options.size ? '' : ' (a twentieth of the diagonal)')], ...changed,
      ['Order of the elements', options.order], ['Coarsening', options.coarsen ? 'on' : 'off'],
      ['Improvement', options.improve === 0 ? 'off' : `level ${options.improve}`]]),
    element('h2', {}, 'Made'),
    table([...countsOf(report), ['Median edge', `${number(check.median_edge)} (${number(check.median_edge / size)} of the size)`],
      ...shapesOf(report),
      ['Farthest from smooth surfaces', number(check.max_surface_distance)], ...regions, ...periodic,
      ['Seconds', Object.entries(report.seconds).map(([stage, s]) => `${stage} ${Number(s.toPrecision(2))}`).join(', ')],
      ['Written to', report.output]]),
    element('h2', {}, 'Guarantees'), guaranteeList(report, show),
    ...(warnings.length > 0 ? [element('h2', {}, 'Warnings and notes'),
      element('ul', {}, ...warnings.slice(0, 50).map(text => element('li', {}, text)))] : []),
    ...layers(report, names, show), ...straightened(report, names, show), ...repairs(report, show),
    ...(shown.worst.length > 0 ? worst(shown, show) : []), ...histogramsOf(report));
}
