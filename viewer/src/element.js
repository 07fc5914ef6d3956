// Elements, and elements that show a value of the report.
import { unit, valueAt } from './data.js';
import { formatted } from './format.js';

export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== false) made.setAttribute(key, value === true ? '' : value);
  }
  made.append(...children.filter((child) => child !== undefined && child !== null));
  return made;
}

// A key, or the quotient or difference of two: "triangles / triangles_extracted".
function evaluated(key) {
  const [first, sign, second] = key.split(' ');
  if (sign === undefined) return valueAt(first);
  return sign === '/' ? valueAt(first) / valueAt(second) : valueAt(first) - valueAt(second);
}

// Text that is broken behind the slashes of paths rather than within names.
function broken(text) {
  return text.split(/(?<=\/)/).flatMap((part, n) => (n > 0 ? [element('wbr'), part] : [part]));
}

// What of the report `key` names, for people to read and exactly in data-value. Nothing where there is no such value.
export function shown(key, format = 'text') {
  const value = evaluated(key);
  if (value === undefined) return undefined;
  if (Array.isArray(value)) return list(key, value, format);
  const number = typeof value === 'number';
  return element('span', {
    'data-key': key,
    'data-value': JSON.stringify(value),
    'data-format': format,
    title: number ? String(value) : undefined,
    class: number ? 'number' : format === 'code' ? 'code' : undefined,
  }, ...broken(formatted(value, number || typeof value === 'boolean' ? format : 'text', unit)));
}

function list(key, values, format) {
  const between = key.endsWith('dims') ? ' × ' : ' ';
  const parts = values.map((_, index) => shown(`${key}.${index}`, format));
  return element('span', { class: 'list' }, ...parts.flatMap((part, index) => (index > 0 ? [between, part] : [part])));
}
