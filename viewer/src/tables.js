// The numbers: tiles on top, cards with tables below.
import { isoTitle, surfaceTitle } from './controls.js';
import { report, unit, valueAt } from './data.js';
import { element, shown } from './element.js';
import { fileName } from './format.js';

// The mesh and the scan, for everybody.
const kMesh = [
  ['File', 'output'], ['Triangles', 'page.check.triangles', 'count'], ['Vertices', 'page.check.vertices', 'count'],
  ['Triangles before simplification', 'triangles_extracted', 'count'], ['Area', 'page.check.area', 'area'],
  ['Volume inside', 'page.check.volume', 'volume'], ['Separate parts', 'page.check.components', 'count'],
  ['Edges on a border (0: closed)', 'page.check.open_edges', 'count'],
  ['Edges of more than two triangles', 'page.check.nonmanifold_edges', 'count'], ['Axes', 'space'], ['Before', 'before'],
];
const kScan = [
  ['File', 'input.path'], ['Part', 'input.part'], ['Format', 'input.format'], ['Samples', 'input.dims', 'count'],
  ['Spacing', 'input.spacing', 'number'], ['Unit', 'input.unit'], ['Type', 'input.type'],
  ['Smallest value', 'input.min', 'number'], ['Largest value', 'input.max', 'number'], ['Values that are no number', 'input.nan', 'count'],
  ['Surface at the value', 'iso', 'number'], ['Inside', 'inside'], ['Closed at the border', 'closed', 'flag'],
  ['Triangles', 'input.triangles', 'count'], ['Vertices', 'input.vertices', 'count'],
];

// The run, for those who ask how.
const kOptions = [
  ['Error that was allowed', 'error', 'length'], ['Triangles asked for', 'target.triangles', 'count'],
  ['Extractor', 'extractor'], ['Quality', 'quality'], ['Order of decisions', 'schedule'], ['Threads', 'threads', 'count'],
  ...(valueAt('slab') > 0 ? [['Layers per slab', 'slab', 'count']] : []), ['Computed by', 'backend'],
  ['Index', 'index.path', 'text', () => valueAt('input.dims') && 'none'],
  ['Chunks left out by the index', 'index.chunks_left_out', 'count'], ['Bytes left out', 'index.bytes_left_out', 'bytes'],
  ['Origin of the scan', 'input.origin', 'number'], ['Directions of its axes', 'input.direction', 'number'],
  ['Slope of its values', 'input.slope', 'number'], ['Intercept of its values', 'input.intercept', 'number'],
];
const kCounts = [
  ['Cells that the surface crosses', 'cells_crossed', 'count'], ['Triangles extracted', 'triangles_extracted', 'count'],
  ['Vertices extracted', 'vertices_extracted', 'count'], ['Edges collapsed', 'collapses', 'count'],
  ['Put off, as not allowed yet', 'postponed', 'count'], ['Put off, as their cost had grown', 'rekeyed', 'count'],
  ['Steps of decisions', 'rounds', 'count'], ['Vertices that had to stay', 'locked_vertices', 'count'],
];
const kTimes = [
  ['Reading', 'seconds.read', 'seconds'], ['Extraction', 'seconds.extract', 'seconds'],
  ['Simplification', 'seconds.simplify', 'seconds'], ['Writing', 'seconds.write', 'seconds'],
  ['Total, as these overlap', 'seconds.total', 'seconds'], ['Total, as forecast', 'forecast.seconds', 'seconds'],
];
const kMemory = [
  ['Most that the run took', 'memory.peak_bytes', 'bytes'], ['As forecast', 'memory.predicted_bytes', 'bytes'],
  ['Smallest cap that it could keep', 'forecast.least_bytes', 'bytes'],
  ['Size of the mesh file, as forecast', 'forecast.output_bytes', 'bytes'],
  ['Triangles, as forecast', 'forecast.triangles', 'count'],
  ['Triangles extracted, as forecast', 'forecast.triangles_extracted', 'count'],
];
const kChecks = [
  ['Triangles', 'triangles', 'count'], ['Vertices', 'vertices', 'count'], ['Open edges', 'open_edges', 'count'],
  ['Non-manifold edges', 'nonmanifold_edges', 'count'], ['Non-manifold vertices', 'nonmanifold_vertices', 'count'],
  ['Misoriented edges', 'misoriented_edges', 'count'], ['Degenerate triangles', 'degenerate_triangles', 'count'],
  ['Unused vertices', 'unused_vertices', 'count'], ['Components', 'components', 'count'],
  ['Euler number', 'euler', 'count'], ['Area', 'area', 'number'], ['Volume', 'volume', 'number'], ['Digest', 'digest', 'code'],
];

function card(title, ...content) {
  return element('article', { class: 'card' }, element('h2', {}, title), ...content);
}

// Rows of what the report has, or of what is said instead; no card where it has nothing.
export function listCard(title, rows) {
  const has = (key) => valueAt(key) !== undefined && valueAt(key) !== '';
  const present = rows.filter(([, key, , instead]) => has(key) || instead?.());
  if (present.length === 0) return undefined;
  const table = element('dl', {});
  for (const [label, key, format, instead] of present) {
    table.append(element('div', {}, element('dt', {}, label), element('dd', {}, has(key) ? shown(key, format) : instead())));
  }
  return card(title, table);
}

// What the run counted beside what the file holds.
function checkCard() {
  const run = (key) => (report.digest === undefined ? undefined : valueAt(key));
  const body = element('tbody', {});
  for (const [label, key, format] of kChecks) {
    const inFile = valueAt(`page.check.${key}`);
    const inRun = run(key);
    const same = inRun === undefined || inRun === inFile;
    body.append(element('tr', { class: same ? undefined : 'differs' },
      element('th', { scope: 'row' }, label),
      element('td', {}, inRun === undefined ? '' : shown(key, format)),
      element('td', {}, shown(`page.check.${key}`, format))));
  }
  const head = element('thead', {}, element('tr', {}, element('th', { scope: 'col' }, 'Check'),
    element('th', { scope: 'col' }, 'Run'), element('th', { scope: 'col' }, 'File read back')));
  return card('Checks of the run and of its file', element('table', {}, head, body));
}

// The checks of each iso-value's file. Those that the run counted otherwise stand out.
function isoCard() {
  const numbers = report.isos.map((_, iso) => iso);
  const scope = (name) => ({ scope: name });
  const row = (label, cells) => element('tr', {}, element('th', scope('row'), label), ...cells);
  const body = kChecks.map(([label, key, format]) => row(label, numbers.map((iso) => {
    const inRun = valueAt(`isos.${iso}.${key}`);
    const same = inRun === undefined || inRun === valueAt(`page.isos.${iso}.${key}`);
    return element('td', { class: same ? undefined : 'differs' }, shown(`page.isos.${iso}.${key}`, format));
  })));
  const first = [['Extracted', 'triangles_extracted', 'count'], ['Mesh file', 'output']].map(([label, key, format]) =>
    row(label, numbers.map((iso) => element('td', {}, shown(`isos.${iso}.${key}`, format)))));
  const head = element('tr', {}, element('th', scope('col'), 'Iso-value'),
    ...numbers.map((iso) => element('th', scope('col'), isoTitle(iso))));
  return card('Each iso-value, by its file', element('div', { class: 'scroll wide', tabindex: '0', role: 'region', 'aria-label': 'Iso-values' },
    element('table', {}, element('thead', {}, head), element('tbody', {}, ...first, ...body))));
}

function distanceCard() {
  const { distance } = report.page;
  if (!distance) return undefined;
  const kinds = [['mean', 'Mean'], ['rms', 'RMS'], ['max', 'Largest']];
  const ways = [['a_to_b', 'Mesh to before'], ['b_to_a', 'Before to mesh'], ['both', 'Both ways']];
  const rows = [['page.distance', 'At vertices'],
    ...(distance.sampled ? ways : []).map(([key, label]) => [`page.distance.sampled.${key}`, label])];
  const head = element('tr', {}, element('th', { scope: 'col' }, `In ${unit}`),
    ...kinds.map(([, label]) => element('th', { scope: 'col' }, label)));
  const body = rows.map(([key, label]) => element('tr', {}, element('th', { scope: 'row' }, label),
    ...kinds.map(([kind]) => element('td', {}, shown(`${key}.${kind}`, 'bare')))));
  const points = distance.sampled ? [', and at ', shown('page.distance.samples', 'count'), ' points spread over each surface by area'] : [];
  const note = element('p', { class: 'small' }, 'At the ', shown('page.distance.vertices', 'count'), ' vertices of the mesh',
    ...points, '. RMS is the typical distance: the root of the mean square.');
  return card('Distance to the surface before simplification',
    element('table', {}, element('thead', {}, head), element('tbody', {}, ...body)), note);
}

function surfaceCard() {
  if (report.page.surfaces.length === 0) return undefined;
  const head = element('tr', {}, ...['Surface', 'Triangles', 'Vertices'].map((name) => element('th', { scope: 'col' }, name)));
  const body = report.page.surfaces.map((_, index) => element('tr', {}, element('th', { scope: 'row' }, surfaceTitle(index)),
    element('td', {}, shown(`page.surfaces.${index}.triangles`, 'count')),
    element('td', {}, shown(`page.surfaces.${index}.vertices`, 'count'))));
  return card('Surfaces in this page', element('table', {}, element('thead', {}, head), element('tbody', {}, ...body)));
}

function noteCard(title, key) {
  const lines = valueAt(key) ?? [];
  if (lines.length === 0) return undefined;
  return card(title, element('ul', {}, ...lines.map((_, index) => element('li', {}, shown(`${key}.${index}`)))));
}

function addCards(id, ...cards) {
  document.getElementById(id).append(...cards.filter(Boolean));
}

export function fillCards() {
  addCards('cards', listCard('The mesh', kMesh), listCard(valueAt('input.dims') ? 'The scan' : 'The mesh before', kScan),
    distanceCard(), report.isos ? isoCard() : undefined, surfaceCard(), noteCard('Notes on the input', 'input.notes'),
    noteCard('Warnings', 'warnings'), noteCard('Notes on the output', 'notes'));
  addCards('expert-cards', listCard('Settings', kOptions), listCard('Counts', kCounts), listCard('Time', kTimes),
    listCard('Memory', kMemory), report.isos ? undefined : checkCard());
}

export function tile(label, value, ...more) {
  return value && element('li', {}, element('span', { class: 'label' }, label), element('strong', {}, value),
    element('span', { class: 'small' }, ...more));
}

function stateText(check) {
  const closed = check.open_edges === 0 ? 'closed' : 'open';
  const manifold = check.nonmanifold_edges === 0 && check.nonmanifold_vertices === 0;
  return `${closed}, ${manifold ? '' : 'not '}manifold`;
}

function stateTile(check) {
  return tile('Surface', element('span', {}, stateText(check)), shown('page.check.components', 'count'),
    check.components === 1 ? ' part' : ' parts');
}

// Width, depth and height of the mesh.
function sizeTile() {
  const sides = [0, 1, 2].flatMap((axis) => [...(axis > 0 ? [' × '] : []),
    shown(`page.check.box.high.${axis} - page.check.box.low.${axis}`, 'bare')]);
  return tile('Size', element('span', {}, ...sides, ` ${unit}`), 'along x, y and z');
}

function errorTile() {
  if (!report.page.distance) return tile('Error that was allowed', shown('error', 'length'), 'typical, not largest');
  return tile('Distance to the surface before', shown('page.distance.rms', 'length'), 'typical (RMS); largest ',
    shown('page.distance.max', 'length'));
}

function isoTile() {
  const values = report.isos.flatMap((_, iso) => [...(iso > 0 ? [', '] : []), shown(`isos.${iso}.iso`, 'number')]);
  return tile('Iso-values', element('span', {}, ...values), 'one pass over the volume');
}

const share = () => [shown('triangles / triangles_extracted', 'percent'), ' of ', shown('triangles_extracted', 'count')];

export function fillTiles() {
  const { check } = report.page;
  const vertices = check ? [shown('page.check.vertices', 'count'), ' vertices'] : [];
  const memory = valueAt('memory.peak_bytes') ? [shown('memory.peak_bytes', 'bytes'), ' of memory'] : [];
  const tiles = [
    tile('Triangles', shown(check ? 'page.check.triangles' : 'triangles', 'count'), ...(report.triangles_extracted > 0 ? share() : vertices)),
    check?.triangles > 0 && sizeTile(),
    check ? stateTile(check) : isoTile(),
    errorTile(),
    tile('Time', shown('seconds.total', 'seconds'), ...memory),
  ];
  document.getElementById('tiles').append(...tiles.filter(Boolean));
}

export function fillNotes() {
  const list = document.getElementById('notes');
  list.append(...report.page.notes.map((_, index) => element('li', {}, shown(`page.notes.${index}`))));
  list.hidden = report.page.notes.length === 0;
}

export function fillHeading() {
  const title = fileName(report.output) || (report.isos && fileName(valueAt('input.path'))) || 'isoweave';
  document.title = `${title} – isoweave`;
  document.getElementById('title').textContent = title;
  const from = report.input ? `from ${fileName(report.input.path)}` : 'Mesh file';
  document.getElementById('subtitle').textContent = report.isos ? 'Surfaces of several iso-values' : from;
  document.getElementById('version').append(' ', shown('version') ?? '');
}
