// Functions that the tests of several pages share: loading, comparing every number with the report, looking at pictures.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { numberIn } from './numbers.mjs';

export const kDesktop = { width: 1320, height: 900 };
export const kSmall = { width: 720, height: 600 }; // for pictures, which processors draw here
export const kPhone = { width: 390, height: 844, touch: true };

// Loads a page, acts on it, and makes sure that it has asked for nothing else and has no errors.
export async function visit(browser, address, screen, act) {
  const page = await browser.open(address, screen);
  try {
    await act(page);
    assert.deepEqual(page.errors, []);
    assert.deepEqual(page.requests.filter((url) => !url.startsWith('data:')), [address]);
  } finally {
    await page.close();
  }
}

const valueAt = (report, key) => key.split('.').reduce((value, part) => value?.[part], report);

function expected(report, key) {
  const [first, sign, second] = key.split(' ');
  const [a, b] = [first, second ?? ''].map((part) => valueAt(report, part));
  return { undefined: () => a, '/': () => a / b, '-': () => a - b }[sign]();
}

// All elements that show a value of the report: what they say exactly, and what is to be read.
const kShown = `[...document.querySelectorAll('[data-key]')].map((shown) =>
  [shown.dataset.key, shown.dataset.value, shown.textContent, shown.dataset.format])`;

// Opens what is folded.
export const openAll = (page) => page.evaluate(`document.querySelectorAll('details').forEach((details) => { details.open = true; });
  new Promise((resolve) => setTimeout(resolve, 50))`);

export async function expectNumbersOf(page, report, atLeast) {
  await openAll(page);
  const shown = await page.evaluate(kShown);
  assert.ok(shown.length >= atLeast, `${shown.length} values`);
  for (const [key, exact, text, format] of shown) {
    const value = expected(report, key);
    assert.deepEqual(JSON.parse(exact), value, key);
    if (typeof value === 'string') assert.equal(text, value === '' ? '–' : value, key);
    if (typeof value !== 'number') continue;
    // Counts to the last digit, the others as far as they are written.
    const tolerance = format === 'count' ? 0 : Math.abs(value) * 0.005;
    assert.ok(Math.abs(numberIn(text) - value) <= tolerance, `${key}: ${value} is shown as '${text}'`);
  }
  const shownKeys = new Set(shown.map(([key]) => key));
  return (prefix) => [...shownKeys].filter((key) => key.startsWith(prefix)).length;
}

// Every number that is to be read on the page is one of the report's: digits outside of such elements are names. The
// state of the view is none of them.
export const kOtherDigits = `(() => {
  const walker = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
  const found = [];
  while (walker.nextNode()) {
    const { parentElement: parent, textContent: text } = walker.currentNode;
    if (/[0-9]/.test(text) && !parent.closest('[data-key], kbd, script, output, .marks, .keys, .u-legend')) found.push(text.trim());
  }
  return found;
})()`;

// The text of an element, as a reader sees it.
export const visibleText = (page, id) => page.evaluate(`(() => {
  const e = document.getElementById('${id}');
  return e.offsetHeight > 0 ? e.innerText : '';
})()`);

// Figures of the picture: how much of the canvas is drawn, in how many colours, and a sum that changes with it.
export const picture = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) => {
  view.drawNow();
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [view.canvas.width, view.canvas.height];
  const context = copy.getContext('2d');
  context.drawImage(view.canvas, 0, 0);
  const words = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  let sum = 0;
  let covered = 0;
  for (const word of words) {
    sum = (Math.imul(sum, 31) + word) | 0;
    if (word !== 0) covered += 1;
  }
  return { sum, covered: covered / words.length, colours: new Set(words).size };
})`);

// The part of the canvas that what is drawn reaches over: in width and in height.
export const reach = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) => {
  view.drawNow();
  const copy = document.createElement('canvas');
  const { width, height } = view.canvas;
  [copy.width, copy.height] = [width, height];
  const context = copy.getContext('2d');
  context.drawImage(view.canvas, 0, 0);
  const words = new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
  const [x, y] = [[Infinity, -Infinity], [Infinity, -Infinity]];
  for (let at = 0; at < words.length; ++at) {
    if (words[at] === 0) continue;
    for (const [range, place] of [[x, at % width], [y, Math.floor(at / width)]]) {
      range[0] = Math.min(range[0], place);
      range[1] = Math.max(range[1], place + 1);
    }
  }
  return [(x[1] - x[0]) / width, (y[1] - y[0]) / height];
})`);

// Moves a slider.
export const slide = (page, id, value) => page.evaluate(`(() => {
  const range = document.getElementById('${id}');
  range.value = ${value};
  range.dispatchEvent(new Event('input'));
})()`);

// Takes a choice of a list.
export const choose = (page, id, value) => page.evaluate(`(() => {
  const choice = document.getElementById('${id}');
  choice.value = '${value}';
  choice.dispatchEvent(new Event('change'));
})()`);

// Nothing on the page is a violation of a rule of axe-core, which lies in this folder of packages.
export async function audit(page, packages) {
  await page.evaluate(readFileSync(join(packages, 'axe-core/axe.min.js'), 'utf8'));
  const found = await page.evaluate(`axe.run(document).then(({ violations }) => violations.map(({ id, nodes }) =>
    id + ': ' + nodes.map(({ html, failureSummary }) => html.slice(0, 120) + ' ' + failureSummary).join(' | ')))`);
  assert.deepEqual(found, []);
}

// The keys that the page names are those of the controls that are to be seen, and tooltips end with them.
export async function expectKeysOfControls(page) {
  const [said, there, bare] = await page.evaluate(`(() => {
    const seen = [...document.querySelectorAll('[aria-keyshortcuts]')].filter((e) => (e.labels?.[0] ?? e).offsetHeight > 0);
    const key = (e) => e.getAttribute('aria-keyshortcuts');
    return [[...document.querySelectorAll('#keys kbd')].map((e) => e.textContent).slice(6), seen.map(key),
      seen.filter((e) => e.localName === 'button' && !e.title.endsWith('(' + key(e) + ')')).map((e) => e.id)];
  })()`);
  assert.deepEqual(said, there);
  assert.deepEqual(bare, []);
}

// Frame and controls lie on the first screen, and the page goes on below.
export async function expectOnFirstScreen(page) {
  const [below, height, inner] = await page.evaluate(`[[...document.querySelectorAll('.stage, .frame, .controls > *, .controls button')]
    .filter((e) => e.offsetHeight > 0 && e.getBoundingClientRect().bottom > innerHeight).map((e) => e.outerHTML.slice(0, 60)),
    document.documentElement.scrollHeight, innerHeight]`);
  assert.deepEqual(below, []);
  assert.ok(height > inner);
}

export const pressed = (page, id) => page.evaluate(`document.getElementById('${id}').getAttribute('aria-pressed')`);
const pause = (page) => page.evaluate('new Promise((resolve) => setTimeout(resolve, 120))');

// Waits until what is drawn holds still.
export const settled = (page) => page.evaluate(`(async () => {
  const after = (time, value) => new Promise((resolve) => setTimeout(resolve, time, value));
  const frame = () => Promise.race([new Promise(requestAnimationFrame), after(200)]);
  const shown = await Promise.race([Promise.resolve(window.isoweave?.ready).catch(() => null), after(1000, null)]);
  const look = () => JSON.stringify([document.documentElement.scrollHeight, shown?.view?.canvas?.width, shown?.view?.canvas?.height,
    shown?.view?.camera?.position.toArray()]);
  await after(120);
  for (let same = 0, tries = 0, last = ''; same < 4 && tries < 40; ++tries) {
    await frame();
    const now = look();
    same = now === last ? same + 1 : 0;
    last = now;
  }
})()`);

// Waits for what comes in its own time.
export async function until(page, condition) {
  for (let tries = 0; tries < 200; ++tries) {
    if (await page.evaluate(condition)) return;
    await pause(page);
  }
  assert.fail(`never: ${condition}`);
}

// The ratio that the Web Content Accessibility Guidelines ask for.
export const kContrasts = `(() => {
  const style = getComputedStyle(document.documentElement);
  const light = (name) => {
    const hex = style.getPropertyValue('--' + name).trim().slice(1);
    const [r, g, b] = [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255)
      .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  return [['ink', 'back'], ['ink', 'card'], ['ink', 'accent-soft'], ['muted', 'back'], ['muted', 'card'], ['muted', 'stage-low'],
    ['muted', 'stage-high'], ['accent', 'card'], ['accent', 'accent-soft'], ['bad', 'card']].map(([a, b]) => {
    const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
    return [a + ' on ' + b, (high + 0.05) / (low + 0.05)];
  });
})()`;

// Nothing sticks out of the screen and of its card.
export async function expectFits(page, width, name) {
  await openAll(page);
  assert.equal(await page.evaluate('document.documentElement.scrollWidth'), width, name);
  const wide = await page.evaluate(`[...document.querySelectorAll('main *, header *')].filter((e) =>
    !e.closest('.scroll, .u-wrap') && e.getBoundingClientRect().right > ${width} + 0.5).map((e) => e.outerHTML.slice(0, 80))`);
  assert.deepEqual(wide, [], name);
  const cards = await page.evaluate(`[...document.querySelectorAll('.card, .tiles li')].filter((card) => {
    const inside = card.getBoundingClientRect().right - parseFloat(getComputedStyle(card).paddingRight);
    return [...card.querySelectorAll('dl, table, span')].some((e) =>
      !e.closest('.scroll, .u-wrap') && e.getBoundingClientRect().right > inside + 1);
  }).map((card) => card.innerText.slice(0, 20))`);
  assert.deepEqual(cards, [], name);
}
