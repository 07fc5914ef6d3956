// What the buttons and keys of all pages have in common. A button names its key in aria-keyshortcuts, and nowhere else.
import { element } from './element.js';

const kTurn = Math.PI / 24;
const kZoom = 1.15;

export const byId = (id) => document.getElementById(id);

// A button that is pressed or not.
export function toggle(id, act) {
  const button = byId(id);
  button.addEventListener('click', () => {
    const on = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(on));
    act(on);
  });
}

// The key of an event on the page, or nothing where it is meant for the browser, a slider or a list.
function pressedKey(event) {
  const meantElsewhere = event.altKey || event.ctrlKey || event.metaKey || event.target.type === 'range' ||
    event.target.localName === 'select';
  return meantElsewhere ? '' : event.key;
}

// Arrows orbit while the canvas has the focus; + and - zoom from anywhere.
function addOrbitKeys(view, canvas) {
  const turns = { ArrowLeft: [-kTurn, 0], ArrowRight: [kTurn, 0], ArrowUp: [0, -kTurn], ArrowDown: [0, kTurn] };
  canvas.addEventListener('keydown', (event) => {
    const turn = turns[pressedKey(event)];
    if (!turn) return;
    view.orbit(...turn);
    event.preventDefault();
  });
  document.addEventListener('keydown', (event) => {
    const key = pressedKey(event);
    if (key === '+' || key === '=') view.orbit(0, 0, kZoom);
    else if (key === '-') view.orbit(0, 0, 1 / kZoom);
  });
}

// Controls with a key that the page shows.
function keyed() {
  return [...document.querySelectorAll('[aria-keyshortcuts]')].filter((control) => !control.closest('[hidden]'));
}

const keyOf = (control) => control.getAttribute('aria-keyshortcuts');

// What a control is called: by its text, or its label's.
const nameOf = (control) => (control.labels?.[0]?.querySelector('b') ?? control).textContent.trim();

const hint = (keys, what) => element('span', {}, ...keys.map((key) => element('kbd', {}, key)), ` ${what}`);

// Keys press the buttons that name them. The page lists those that there are, and tooltips end with them.
export function startKeys(view) {
  addOrbitKeys(view, view.canvas);
  document.addEventListener('keydown', (event) => {
    const key = pressedKey(event);
    if (key) keyed().find((control) => keyOf(control) === key)?.click();
  });
  for (const control of keyed()) {
    if (control.title) control.title = `${control.title} (${keyOf(control)})`;
  }
  byId('keys').replaceChildren(hint(['←', '↑', '↓', '→'], 'turn'), hint(['+', '−'], 'zoom'),
    ...keyed().map((control) => hint([keyOf(control)], nameOf(control).toLowerCase())));
}
