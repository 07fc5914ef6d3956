// Plots: how many vertices are how far from the surface before, and triangles and memory along the sweep.
import uPlot from 'uplot';
import { errorColour } from './colours.js';
import { report, unit } from './data.js';
import { byId } from './buttons.js';
import { element, shown } from './element.js';
import { formatted } from './format.js';
import {
  kHeight, logAxis, memoryOptions, nameAxis, positive, series, triangleOptions,
} from './plot_style.js';

const kStops = 32; // of the colours of distances
const plots = []; // { make, host, plot }

const column = (key) => report.sweep.map((record) => record[key]);
const few = () => ({ show: report.sweep.length < 30, size: 6 });

const bins = () => report.page.distance.bins;

// The colours that the distances have on the mesh.
function errorFill({ ctx: context, bbox }) {
  const fill = context.createLinearGradient(bbox.left, 0, bbox.left + bbox.width, 0);
  for (let stop = 0; stop <= kStops; ++stop) fill.addColorStop(stop / kStops, `rgb(${errorColour(stop / kStops).join(' ')})`);
  return fill;
}

function errorOptions() {
  const bars = uPlot.paths.bars({ size: [0.9, 100], align: 1 });
  return {
    scales: {
      x: { time: false, range: () => [0, report.page.distance.max || 1] },
      y: { distr: 3, range: (_, low, high) => [0.5, high * 1.6] },
    },
    axes: [nameAxis(`distance (${unit})`, (value) => formatted(value, 'bare')), logAxis()],
    series: [
      { label: 'From', value: (_, value) => (value === null ? '–' : formatted(value, 'length', unit)) },
      series('Vertices', 'muted', 'count', { paths: bars, points: { show: false }, fill: errorFill, width: 0.5 }),
    ],
    legend: { show: false },
  };
}

// The numbers of a plot, for those who cannot see it. Filled when it is opened: sweeps have thousands of slabs.
export function numberTable(title, columns, rowCount, cells) {
  const details = element('details', {}, element('summary', {}, 'Numbers'));
  details.addEventListener('toggle', () => {
    if (!details.open || details.querySelector('table')) return;
    const head = element('tr', {}, ...columns.map((name) => element('th', { scope: 'col' }, name)));
    const rows = Array.from({ length: rowCount }, (_, row) =>
      element('tr', {}, ...cells(row).map((cell) => element('td', {}, cell))));
    const table = element('table', {}, element('thead', {}, head), element('tbody', {}, ...rows));
    details.append(element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': `Numbers: ${title}` }, table));
  });
  return details;
}

function addPlot(place, id, title, say, options, data, table) {
  const host = element('div', { class: 'plot', role: 'img', 'aria-label': say });
  byId(place).append(element('article', { class: 'card', id }, element('h2', {}, title), host, table));
  byId(place).hidden = false;
  plots.push({ make: () => new uPlot({ ...options(), width: host.clientWidth, height: kHeight }, data, host), host });
}

function addSweepPlots() {
  const layers = column('layer');
  const cells = (keys) => (row) => keys.map(([key, format]) => shown(`sweep.${row}.${key}`, format));
  addPlot('sweep-plots', 'plot-triangles', 'Triangles along the sweep',
    'Final, live and undecided triangles after each slab, on a logarithmic scale', () => triangleOptions(few()),
    [layers, ...['final_triangles', 'live_triangles', 'undecided_triangles'].map((key) => positive(column(key)))],
    numberTable('triangles along the sweep', ['Layers', 'Final', 'Live', 'Undecided'], layers.length, cells([['layer', 'count'],
      ['final_triangles', 'count'], ['live_triangles', 'count'], ['undecided_triangles', 'count']])));
  addPlot('sweep-plots', 'plot-memory', 'Memory along the sweep',
    'Bytes that slab and undecided zone hold after each slab', () => memoryOptions(few()),
    [layers, column('bytes')],
    numberTable('memory along the sweep', ['Layers', 'Bytes'], layers.length, cells([['layer', 'count'], ['bytes', 'bytes']])));
}

function addErrorPlot() {
  addPlot('plots', 'plot-error', 'How far the mesh is from the surface before simplification',
    'How many vertices of the mesh lie how far from the surface before, on a logarithmic scale', errorOptions,
    [bins().map(({ from }) => from), positive(bins().map(({ vertices }) => vertices))],
    numberTable('distances', ['From', 'To', 'Vertices'], bins().length, (row) => [shown(`page.distance.bins.${row}.from`, 'length'),
      shown(`page.distance.bins.${row}.to`, 'length'), shown(`page.distance.bins.${row}.vertices`, 'count')]));
}

// The colours of a plot are fixed when it is made.
export function drawPlots() {
  for (const entry of plots) {
    entry.plot?.destroy();
    entry.plot = entry.make();
  }
}

export function startPlots() {
  if (report.page.distance) addErrorPlot();
  if (report.sweep?.length > 0) addSweepPlots();
  const observer = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      plots.find(({ host }) => host === target)?.plot?.setSize({ width: target.clientWidth, height: kHeight });
    }
  });
  for (const { host } of plots) observer.observe(host);
}

// What the plots were given, for tests.
export const plotData = () => Object.fromEntries(plots.map(({ host, plot }) => [host.parentElement.id, plot.data]));
