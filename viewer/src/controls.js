// Buttons, sliders and keys of the view.
import { addOrbitKeys, byId, pressedKey, toggle } from './buttons.js';
import { report } from './data.js';
import { element, shown } from './element.js';
import { drawLegend } from './colours.js';
import { slabCount } from './slabs.js';

// The surface of the mesh itself, or of what stands in for it; -1 where there is none.
export function resultIndex() {
  return report.page.surfaces.findIndex(({ name }) => name === 'mesh' || name === 'stand-in');
}

export function surfaceNames() {
  let level = 0;
  const names = { full: 'Before', mesh: 'Result', 'stand-in': 'Stand-in' };
  return report.page.surfaces.map((surface) =>
    (surface.level === undefined ? names[surface.name] ?? `LOD ${(level += 1)}` : `LOD ${surface.level}`));
}

// The name of a surface in the list of them, or its iso-value with its colour.
export function surfaceTitle(index) {
  const { iso } = report.page.surfaces[index];
  return iso === undefined ? surfaceNames()[index] : isoTitle(iso);
}

export function isoTitle(iso) {
  const swatch = element('i', { class: 'swatch', 'aria-hidden': 'true' });
  swatch.style.backgroundColor = report.isos[iso].color;
  return element('span', {}, swatch, shown(`isos.${iso}.iso`, 'number'));
}

// A button per surface: one of them is chosen, or each is on or off. `choose` is called with its number, and whether
// it is on.
function addSurfaces(choose, several) {
  const box = byId('surfaces').querySelector('div');
  byId('surfaces').querySelector('legend').textContent = several ? 'Iso-values' : 'Surface';
  report.page.surfaces.forEach((_, index) => {
    const input = element('input', {
      type: several ? 'checkbox' : 'radio', name: 'surface', id: `surface-choice-${index}`, value: index,
    });
    input.addEventListener('change', () => choose(index, input.checked));
    box.append(input, element('label', { for: input.id }, element('b', {}, surfaceTitle(index)),
      shown(`page.surfaces.${index}.triangles`, 'count')));
  });
}

export function markSurface(index) {
  byId(`surface-choice-${index}`).checked = true;
  byId('drawn').textContent = '';
  byId('split-line').lastChild.textContent = surfaceNames()[index].toLowerCase();
  byId('drawn').append(`${surfaceNames()[index]}: `, shown(`page.surfaces.${index}.triangles`, 'count'), ' triangles');
}

function addErrors(view) {
  const { distance } = report.page;
  byId('error').hidden = !distance;
  if (!distance) return;
  drawLegend(byId('legend-bar'));
  byId('legend-title').append('Distance to the full surface');
  byId('legend-low').append('0');
  byId('legend-high').append(shown('page.distance.max', 'length'));
  toggle('error', (on) => {
    view.setErrorColours(on);
    byId('legend').hidden = !on;
  });
}

function addSlabs(view, middle) {
  byId('slabs').hidden = slabCount === 0;
  if (slabCount === 0) return;
  view.makePlanes(middle);
  const range = byId('cut-range');
  range.max = slabCount;
  const cut = () => {
    const slab = Number(range.value) - 1;
    const all = slab === slabCount - 1 || byId('cut').hidden;
    view.cut(all ? null : slab, middle);
    byId('cut-value').replaceChildren('layer ', shown(`sweep.${slab}.layer`, 'count'));
  };
  range.value = slabCount;
  range.addEventListener('input', cut);
  toggle('slabs', (on) => {
    view.setPlanes(on);
    byId('cut').hidden = !on;
    cut();
  });
  cut();
}

// The surface before simplification beside what is chosen, each on its side of a line.
function addSplit(view, startSplit) {
  const possible = report.page.surfaces[0].name === 'full';
  byId('compare').hidden = !possible;
  if (!possible) return;
  const range = byId('split-range');
  const move = () => {
    const shown = !byId('split').hidden;
    view.setSplit(shown ? range.value / 100 : null);
    byId('split-line').hidden = !shown;
    byId('split-line').style.left = `${range.value}%`;
    range.setAttribute('aria-valuetext', `${range.value} percent of the width`);
  };
  range.addEventListener('input', move);
  toggle('compare', async (on) => {
    byId('split').hidden = !on;
    if (on) await startSplit();
    move();
  });
}

function addKeys(view, choose, current, several) {
  const presses = { w: 'wireframe', s: 'smooth', e: 'error', p: 'slabs', c: 'compare', 0: 'reset' };
  addOrbitKeys(view, byId('view'));
  document.addEventListener('keydown', (event) => {
    const key = pressedKey(event);
    if (presses[key] && !byId(presses[key]).hidden) byId(presses[key]).click();
    else if (key === 'b' && report.page.surfaces[0].name === 'full') choose(current() === 0 ? resultIndex() : 0);
    else if (!/^[1-9]$/.test(key) || Number(key) > report.page.surfaces.length) return;
    else if (several) byId(`surface-choice-${Number(key) - 1}`).click();
    else choose(Number(key) - 1);
  });
}

// `choose` shows a surface by its number, `current` tells which one is shown, `startSplit` brings in the one before.
// `several`: surfaces are shown together, and `choose` is told whether one of them is on.
export function startControls(view, middle, { several = false, choose, current, startSplit }) {
  addSurfaces(choose, several);
  toggle('wireframe', (on) => view.setWireframe(on));
  toggle('smooth', (on) => view.setSmooth(on));
  byId('reset').addEventListener('click', () => view.reset());
  addErrors(view);
  addSlabs(view, middle);
  addSplit(view, startSplit);
  addKeys(view, choose, current, several);
}
