// What the buttons and keys of all pages have in common.

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

// The key of an event on the page, or nothing where it is meant for the browser or a slider.
export function pressedKey(event) {
  const meantElsewhere = event.altKey || event.ctrlKey || event.metaKey || event.target.type === 'range';
  return meantElsewhere ? '' : event.key;
}

// Arrows orbit while the canvas has the focus; + and - zoom from anywhere.
export function addOrbitKeys(view, canvas) {
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
