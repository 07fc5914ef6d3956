// Numbers for people. What is exact stands beside them, in data-value and in a title.

const grouped = new Intl.NumberFormat('en-US');

// Significant digits without trailing zeros; powers of ten only where digits would not do.
function significant(value, digits) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) return minus(value.toExponential(digits - 1).replace(/\.?0+e/, 'e'));
  return minus(new Intl.NumberFormat('en-US', { maximumSignificantDigits: digits }).format(value));
}

const minus = (text) => text.replace(/-/g, '−');

function scaled(value, base, units) {
  let place = 0;
  while (place + 1 < units.length && Math.abs(value) >= base) {
    value /= base;
    place += 1;
  }
  return `${significant(value, 3)} ${units[place]}`;
}

const formats = {
  count: (value) => minus(grouped.format(value)),
  number: (value) => significant(value, 7),
  bare: (value) => significant(value, 4),
  length: (value, unit) => `${significant(value, 4)} ${unit}`,
  area: (value, unit) => `${significant(value, 5)} ${unit}²`,
  volume: (value, unit) => `${significant(value, 5)} ${unit}³`,
  seconds: (value) => (value < 0.1 ? `${significant(value * 1000, 3)} ms` : `${significant(value, 4)} s`),
  bytes: (value) => scaled(value, 1000, ['B', 'kB', 'MB', 'GB', 'TB']),
  percent: (value) => `${significant(value * 100, 3)} %`,
  flag: (value) => (value ? 'yes' : 'no'),
  text: (value) => (value === '' ? '–' : String(value)),
};

export function formatted(value, format, unit) {
  return value === null ? '–' : formats[format](value, unit);
}

// For axes, where room is short.
export function short(value) {
  const size = Math.abs(value);
  const [base, suffix] = size >= 1e9 ? [1e9, ' G'] : size >= 1e6 ? [1e6, ' M'] : size >= 1e4 ? [1e3, ' k'] : [1, ''];
  return significant(value / base, 3) + suffix;
}

export const fileName = (path) => String(path ?? '').split('/').pop();
