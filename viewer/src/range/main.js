// The page of info --isos: about how many triangles the surface of each iso-value has.
import uPlot from 'uplot';
import { byId, toggle } from '../buttons.js';
import { report, valueAt } from '../data.js';
import { element, shown } from '../element.js';
import { fileName, formatted, short } from '../format.js';
import { axis, faint, logAxis, nameAxis, positive, series } from '../plot_style.js';
import { numberTable } from '../plots.js';
import { listCard, tile } from '../tables.js';
import { startTheme } from '../theme.js';

const kHeight = 320;

const isos = report.isos.vertices.map((_, n) => report.isos.first + report.isos.step * n);
const triangles = report.isos.vertices.map((vertices) => 2 * vertices);

const kSuggested = [
  ['Of the formula', 'suggested_iso.formula', 'number'], ['Otsu’s threshold', 'suggested_iso.otsu', 'number'],
  ['Of three classes', 'suggested_iso.three_classes', 'number'], ['Skin in CT', 'suggested_iso.presets.skin', 'number'],
  ['Bone in CT', 'suggested_iso.presets.bone', 'number'], ['Lung in CT', 'suggested_iso.presets.lung', 'number'],
];
const kVolume = [
  ['File', 'input.path'], ['Part', 'input.part'], ['Format', 'input.format'], ['Samples', 'input.dims', 'count'],
  ['Type', 'input.type'], ['Spacing', 'input.spacing', 'number'], ['Unit', 'input.unit'],
  ['Smallest value', 'input.min', 'number'], ['Largest value', 'input.max', 'number'], ['NaN samples', 'input.nan', 'count'],
];

// The suggested values, each once.
function suggested() {
  const values = kSuggested.flatMap(([, key]) => valueAt(key) ?? []);
  return [...new Set(values)].filter((value) => value >= isos[0] && value <= isos.at(-1));
}

// A line at each suggested value, from the bottom to the top of the plot.
function drawSuggested(plot) {
  const { ctx: context, bbox } = plot;
  context.save();
  context.strokeStyle = faint('muted', 'bb');
  context.lineWidth = devicePixelRatio;
  context.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
  for (const value of suggested()) {
    const x = Math.round(plot.valToPos(value, 'x', true));
    context.beginPath();
    context.moveTo(x, bbox.top);
    context.lineTo(x, bbox.top + bbox.height);
    context.stroke();
  }
  context.restore();
}

class Chart {
  constructor() {
    this.host = byId('chart');
    this.logarithmic = false;
    new ResizeObserver(() => this.plot?.setSize({ width: this.host.clientWidth, height: kHeight })).observe(this.host);
  }

  options() {
    const y = this.logarithmic ? { distr: 3 } : { range: (_, low, high) => [0, high * 1.08 || 1] };
    return {
      width: this.host.clientWidth,
      height: kHeight,
      scales: { x: { time: false }, y },
      axes: [nameAxis('iso-value', (value) => formatted(value, 'number')), this.logarithmic ? logAxis() : axis(short, { size: 58 })],
      series: [{ label: 'Iso-value', value: (_, value) => (value === null ? '–' : formatted(value, 'number')) },
        series('Triangles, about', 'plot-final', 'count', { fill: faint('plot-final'), points: { show: false } })],
      hooks: { draw: [drawSuggested] },
    };
  }

  // Colours and the kind of an axis are fixed when a plot is made.
  draw() {
    this.plot?.destroy();
    this.plot = new uPlot(this.options(), [isos, this.logarithmic ? positive(triangles) : triangles], this.host);
  }

  // Points at a value, as the pointer does.
  point(n) {
    const [left, top] = [this.plot.valToPos(isos[n], 'x'), this.plot.valToPos(triangles[n] || 1, 'y')];
    this.plot.setCursor({ left, top: Math.min(Math.max(top, 0), this.plot.over.clientHeight) });
  }
}

// Chooses a value without a pointer.
function startChoice(chart) {
  const range = byId('iso');
  range.max = isos.length - 1;
  const say = () => {
    const n = Number(range.value);
    const text = `--iso ${formatted(isos[n], 'number')}: about ${formatted(triangles[n], 'count')} triangles`;
    byId('chosen').textContent = text;
    range.setAttribute('aria-valuetext', text);
  };
  range.addEventListener('input', () => {
    say();
    chart.point(Number(range.value));
  });
  const first = suggested()[0] ?? (isos[0] + isos.at(-1)) / 2;
  range.value = Math.round((first - report.isos.first) / report.isos.step);
  say();
}

function startChart() {
  const chart = new Chart();
  toggle('log', (on) => {
    chart.logarithmic = on;
    chart.draw();
  });
  startTheme(() => chart.draw());
  startChoice(chart);
  byId('table').append(numberTable('triangles by iso-value', ['Iso-value', 'Triangles, about'], isos.length,
    (n) => [formatted(isos[n], 'number'), formatted(triangles[n], 'count')]));
  return chart;
}

// A volume of one value has no surface.
function hideChart() {
  byId('message').textContent = 'All samples are one value: there is no surface.';
  byId('message').hidden = false;
  for (const id of ['chart', 'choice']) byId(id).hidden = true;
  startTheme(() => undefined);
}

function fillText() {
  const name = fileName(report.input.path);
  document.title = `${name} – isoweave`;
  byId('title').textContent = name;
  byId('subtitle').textContent = 'Triangles by iso-value';
  byId('version').append(' ', shown('version'));
  const tiles = [
    tile('Samples', shown('input.dims', 'count'), shown('input.type')),
    tile('Values', element('span', {}, shown('input.min', 'number'), ' to ', shown('input.max', 'number')),
      shown('input.nan', 'count'), ' NaN'),
    tile('Suggested', shown('suggested_iso.formula', 'number') ?? shown('suggested_iso.otsu', 'number'),
      valueAt('suggested_iso.formula') === undefined ? 'Otsu’s threshold' : 'the formula’s surface'),
  ];
  byId('tiles').append(...tiles.filter(Boolean));
  byId('numbers').append(...[listCard('Volume', kVolume), listCard('Suggested iso-values', kSuggested)].filter(Boolean));
}

fillText();
const chart = isos.length > 0 ? startChart() : hideChart();
// For tests.
window.isoweave = { ready: Promise.resolve(), data: () => chart?.plot.data, cursor: () => chart?.plot.cursor };
