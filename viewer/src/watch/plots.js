// Triangles and memory along the sweep, as far as it has come.
import uPlot from 'uplot';
import { element } from '../element.js';
import { formatted } from '../format.js';
import { kHeight, memoryOptions, positive, triangleOptions } from '../plot_style.js';

const plots = []; // { host, make, columns, table, plot }
let sweep = { layer: [], live: [], undecided: [], final: [], bytes: [] };
let layers = 1;

const kNames = { layer: 'Layers', final: 'Final', live: 'Live', undecided: 'Undecided', bytes: 'Bytes' };
const all = () => ({ time: false, range: () => [0, layers] });
const points = { show: false };

// For those who cannot see the plot. As it was when it was opened: it would move away from under its reader.
function numberTable(title, columns) {
  const box = element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': `Numbers: ${title}` });
  const details = element('details', {}, element('summary', {}, 'Numbers'), box);
  details.addEventListener('toggle', () => {
    if (!details.open) return;
    const head = element('tr', {}, ...columns.map((key) => element('th', { scope: 'col' }, kNames[key])));
    const rows = sweep.layer.map((_, row) => element('tr', {}, ...columns.map((key) =>
      element('td', {}, formatted(sweep[key][row], key === 'bytes' ? 'bytes' : 'count')))));
    box.replaceChildren(element('table', {}, element('thead', {}, head), element('tbody', {}, ...rows)));
  });
  return details;
}

const dataOf = (columns) => columns.map((key) => (key === 'layer' || key === 'bytes' ? sweep[key] : positive(sweep[key])));

function addPlot(id, title, say, options, columns) {
  const host = element('div', { class: 'plot', role: 'img', 'aria-label': say });
  document.getElementById('plots').append(element('article', { class: 'card', id }, element('h2', {}, title), host,
    numberTable(title, columns)));
  plots.push({
    host, columns, make: () => new uPlot({ ...options(), width: host.clientWidth, height: kHeight }, dataOf(columns), host),
  });
}

// The colours of a plot are fixed when it is made.
export function drawPlots() {
  for (const entry of plots) {
    entry.plot?.destroy();
    entry.plot = entry.make();
  }
}

export function growPlots(plot, layerCount) {
  sweep = plot;
  layers = layerCount;
  for (const { plot: drawn, columns } of plots) drawn.setData(dataOf(columns));
}

export function startPlots() {
  addPlot('plot-triangles', 'Triangles along the sweep',
    'Final, live and undecided triangles after each slab so far, on a logarithmic scale',
    () => triangleOptions(points, all()), ['layer', 'final', 'live', 'undecided']);
  addPlot('plot-memory', 'Memory along the sweep', 'Bytes that slab and undecided zone hold after each slab so far',
    () => memoryOptions(points, all()), ['layer', 'bytes']);
  const observer = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      plots.find(({ host }) => host === target)?.plot?.setSize({ width: target.clientWidth, height: kHeight });
    }
  });
  for (const { host } of plots) observer.observe(host);
}

// What the plots were given, for tests.
export const plotData = () => sweep;
