// The numbers: tiles on top, cards with tables below.
import { isoTitle, surfaceTitle } from './controls.js';
import { report, unit, valueAt } from './data.js';
import { element, shown } from './element.js';

const kInput = [
  ['File', 'input.path'], ['Part', 'input.part'], ['Format', 'input.format'], ['Samples', 'input.dims', 'count'],
  ['Type', 'input.type'], ['Spacing', 'input.spacing', 'number'], ['Unit', 'input.unit'],
  ['Origin', 'input.origin', 'number'], ['Direction', 'input.direction', 'number'], ['Space', 'input.space'],
  ['Slope', 'input.slope', 'number'], ['Intercept', 'input.intercept', 'number'], ['Smallest value', 'input.min', 'number'],
  ['Largest value', 'input.max', 'number'], ['NaN samples', 'input.nan', 'count'],
  ['Triangles', 'input.triangles', 'count'], ['Vertices', 'input.vertices', 'count'], ['Before', 'before'],
];
const kOptions = [
  ['Iso-value', 'iso', 'number'], ['Inside', 'inside'], ['Closed at the border', 'closed', 'flag'],
  ['Extractor', 'extractor'], ['Error', 'error', 'length'], ['Triangles asked for', 'target.triangles', 'count'], ['Quality', 'quality'],
  ['Schedule', 'schedule'], ['Threads', 'threads', 'count'], ['Layers per slab (0: as it fits)', 'slab', 'count'],
  ['Back end', 'backend'], ['Index', 'index.path', 'text', () => valueAt('input.dims') && 'none'],
  ['Chunks left out by the index', 'index.chunks_left_out', 'count'], ['Bytes left out', 'index.bytes_left_out', 'bytes'],
  ['Coordinates', 'space'], ['Mesh file', 'output'],
];
const kCounts = [
  ['Cells crossed', 'cells_crossed', 'count'], ['Triangles extracted', 'triangles_extracted', 'count'],
  ['Vertices extracted', 'vertices_extracted', 'count'], ['Collapses', 'collapses', 'count'],
  ['Postponed', 'postponed', 'count'], ['Keyed anew', 'rekeyed', 'count'], ['Rounds', 'rounds', 'count'],
  ['Locked vertices', 'locked_vertices', 'count'], ['Triangles', 'triangles', 'count'], ['Vertices', 'vertices', 'count'],
];
const kTimes = [
  ['Reading', 'seconds.read', 'seconds'], ['Extraction', 'seconds.extract', 'seconds'],
  ['Simplification', 'seconds.simplify', 'seconds'], ['Writing', 'seconds.write', 'seconds'],
  ['In all', 'seconds.total', 'seconds'], ['Predicted', 'forecast.seconds', 'seconds'],
];
const kMemory = [
  ['Peak of the process', 'memory.peak_bytes', 'bytes'], ['Predicted', 'memory.predicted_bytes', 'bytes'],
  ['Least that would do', 'forecast.least_bytes', 'bytes'], ['Mesh file, predicted', 'forecast.output_bytes', 'bytes'],
  ['Triangles, predicted', 'forecast.triangles', 'count'],
  ['Extracted, predicted', 'forecast.triangles_extracted', 'count'],
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

const kParts = ['read', 'extract', 'simplify', 'write'];

// The parts of the time as one bar. They overlap in the run, so they are parts of their sum.
function timeBar() {
  const parts = kParts.map((name) => [name, valueAt(`seconds.${name}`) ?? 0]);
  const sum = parts.reduce((total, [, seconds]) => total + seconds, 0);
  if (!(sum > 0)) return undefined;
  const bar = element('div', { class: 'bar', 'aria-hidden': 'true' });
  for (const [name, seconds] of parts) {
    const part = element('i', { class: `part-${name}` });
    part.style.flexGrow = seconds / sum;
    bar.append(part);
  }
  return bar;
}

function timeCard() {
  const made = listCard('Time', kTimes);
  const bar = timeBar();
  if (made && bar) made.querySelector('h2').after(bar);
  return made;
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
  return card('Checks', element('table', {}, head, body));
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
  if (!report.page.distance) return undefined;
  const kinds = [['mean', 'Mean'], ['rms', 'RMS'], ['max', 'Largest']];
  const ways = [['a_to_b', 'To the full surface'], ['b_to_a', 'From the full surface'], ['both', 'Both ways']];
  const rows = [['page.distance', 'At vertices'], ...ways.map(([key, label]) => [`page.distance.sampled.${key}`, label])];
  const head = element('tr', {}, element('th', { scope: 'col' }, unit ? `In ${unit}` : ''),
    ...kinds.map(([, label]) => element('th', { scope: 'col' }, label)));
  const body = rows.map(([key, label]) => element('tr', {}, element('th', { scope: 'row' }, label),
    ...kinds.map(([kind]) => element('td', {}, shown(`${key}.${kind}`, 'bare')))));
  const note = element('p', { class: 'small' }, 'At the ', shown('page.distance.vertices', 'count'),
    ' vertices of the mesh, and at ', shown('page.distance.samples', 'count'), ' points spread over each surface by area.');
  return card('Distance to the full surface',
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

export function fillCards() {
  const cards = [
    listCard('Input', kInput), listCard('Options', kOptions), listCard('Counts', kCounts), timeCard(),
    listCard('Memory', kMemory), report.isos ? isoCard() : checkCard(), distanceCard(), surfaceCard(),
    noteCard('Notes on the input', 'input.notes'), noteCard('Warnings', 'warnings'), noteCard('Notes on the output', 'notes'),
  ];
  document.getElementById('numbers').append(...cards.filter(Boolean));
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
  const parts = check.components === 1 ? ' component, Euler ' : ' components, Euler ';
  return tile('Surface', element('span', {}, stateText(check)), shown('page.check.components', 'count'), parts,
    shown('page.check.euler', 'count'));
}

function isoTile() {
  const values = report.isos.flatMap((_, iso) => [...(iso > 0 ? [', '] : []), shown(`isos.${iso}.iso`, 'number')]);
  return tile('Iso-values', element('span', {}, ...values), 'one pass over the volume');
}

const share = () => [shown('triangles / triangles_extracted', 'percent'), ' of ', shown('triangles_extracted', 'count')];

export function fillTiles() {
  const { check, distance } = report.page;
  const vertices = check ? [shown('page.check.vertices', 'count'), ' vertices'] : [];
  const counts = report.triangles_extracted > 0 ? share() : vertices;
  const digest = () => tile('Digest', shown('page.check.digest', 'code'), ...(report.digest === undefined ? []
    : [report.digest === check.digest ? 'the run’s, and the file’s' : 'of the file: the run’s is another']));
  const tiles = [
    tile('Triangles', shown(check ? 'page.check.triangles' : 'triangles', 'count'), ...counts),
    check ? stateTile(check) : isoTile(),
    tile('Error', shown('error', 'length'), ...(distance
      ? ['largest found ', shown('page.distance.max', 'length')] : [])),
    tile('Time', shown('seconds.total', 'seconds'), ...(report.threads
      ? ['on ', shown('threads', 'count'), report.threads === 1 ? ' thread' : ' threads'] : [])),
    tile('Peak memory', shown('memory.peak_bytes', 'bytes'), ...(valueAt('memory.predicted_bytes')
      ? ['predicted ', shown('memory.predicted_bytes', 'bytes')] : [])),
    check ? digest() : tile('Digest', shown('digest', 'code'), 'of all surfaces'),
  ];
  document.getElementById('tiles').append(...tiles.filter(Boolean));
}

export function fillNotes() {
  const list = document.getElementById('notes');
  list.append(...report.page.notes.map((_, index) => element('li', {}, shown(`page.notes.${index}`))));
  list.hidden = report.page.notes.length === 0;
}

export const fileName = (path) => String(path ?? '').split('/').pop();

export function fillHeading() {
  const title = fileName(report.output) || (report.isos && fileName(valueAt('input.path'))) || 'isoweave';
  document.title = `${title} – isoweave`;
  document.getElementById('title').textContent = title;
  const from = report.input ? `from ${fileName(report.input.path)}` : 'Mesh file';
  document.getElementById('subtitle').textContent = report.isos ? 'Surfaces of several iso-values' : from;
  document.getElementById('version').append(' ', shown('version') ?? '');
}
