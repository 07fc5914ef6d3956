// What all plots look like.
import { formatted, short } from './format.js';

export const kHeight = 250;

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
export const faint = (name, alpha = '26') => `${colour(name)}${alpha}`;

export function axis(values, more = {}) {
  return {
    stroke: colour('muted'),
    grid: { stroke: colour('line'), width: 1 },
    ticks: { stroke: colour('line'), width: 1, size: 4 },
    font: '12px system-ui, sans-serif',
    values: (_, ticks) => ticks.map((tick) => (tick === null ? '' : values(tick))),
    ...more,
  };
}

export function series(label, name, format, more = {}) {
  return {
    label,
    stroke: colour(name),
    width: 2,
    value: (_, value) => (value === null || value === undefined ? '–' : formatted(value, format)),
    ...more,
  };
}

// Of a logarithmic axis, only powers of ten: there are nine times as many other lines.
const decades = {
  filter: (_, ticks) => ticks.map((tick) => (Number.isInteger(Math.log10(tick)) ? tick : null)),
};
export const logAxis = () => axis(short, { size: 58, ...decades, grid: { stroke: colour('line'), width: 1, ...decades } });
export const nameAxis = (label, values) => axis(values, { label, size: 28, labelSize: 20, labelFont: '12px system-ui, sans-serif' });

// Nothing has no logarithm.
export const positive = (values) => values.map((value) => (value > 0 ? value : null));

// The legend names the lines; the numbers are in the table.
const kNames = { live: false };
const layerSeries = { label: 'Layers', value: (_, value) => (value === null ? '–' : formatted(value, 'count')) };

// Triangles along the sweep: final, live, undecided.
export function triangleOptions(points, xScale = { time: false }) {
  return {
    scales: { x: xScale, y: { distr: 3 } },
    axes: [nameAxis('layers swept', short), logAxis()],
    series: [
      layerSeries,
      series('Final', 'plot-final', 'count', { points }),
      series('Live', 'plot-live', 'count', { points }),
      series('Undecided', 'plot-undecided', 'count', { points, dash: [5, 4] }),
    ],
    legend: kNames,
  };
}

// Bytes along the sweep.
export function memoryOptions(points, xScale = { time: false }) {
  return {
    scales: { x: xScale, y: { range: (_, low, high) => [0, high * 1.08 || 1] } },
    axes: [nameAxis('layers swept', short), axis((value) => formatted(value, 'bytes'), { size: 66 })],
    series: [layerSeries,
      series('Held by slab and zone', 'plot-memory', 'bytes', { points, fill: faint('plot-memory') })],
    legend: kNames,
  };
}
