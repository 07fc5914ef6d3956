// Buttons, sliders and keys of the view.
import { byId, startKeys, toggle } from './buttons.js';
import { report, space, unit } from './data.js';
import { element, shown } from './element.js';
import { drawLegend } from './colours.js';
import { startMarks } from './marks.js';
import { startMeasure } from './measure.js';
import { startSection } from './section.js';
import { addViews } from './views.js';

const kDigits = 9; // keys for surfaces

// The surface of the mesh itself, or of what stands in for it; -1 where there is none.
export function resultIndex() {
  return report.page.surfaces.findIndex(({ name }) => name === 'mesh' || name === 'stand-in');
}

const hasBefore = () => report.page.surfaces[0].name === 'full';

// A mesh of no run is nobody's result.
export function surfaceNames() {
  let level = 0;
  const result = report.digest === undefined ? 'Mesh' : 'Result';
  const names = { full: 'Before', mesh: result, 'stand-in': 'Stand-in' };
  return report.page.surfaces.map((surface) =>
    (surface.level === undefined ? names[surface.name] ?? `Coarser ${(level += 1)}` : `LOD ${surface.level}`));
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
      'aria-keyshortcuts': index < kDigits && String(index + 1),
    });
    input.addEventListener('change', () => choose(index, input.checked));
    box.append(input, element('label', { for: input.id }, element('b', {}, surfaceTitle(index)),
      shown(`page.surfaces.${index}.triangles`, 'count')));
  });
}

export function markSurface(index) {
  byId(`surface-choice-${index}`).checked = true;
  byId('drawn').textContent = '';
  byId('split-labels').lastChild.textContent = surfaceNames()[index].toLowerCase();
  byId('drawn').append(`${surfaceNames()[index]}: `, shown(`page.surfaces.${index}.triangles`, 'count'), ' triangles');
}

function addErrors(view) {
  const { distance } = report.page;
  byId('error').hidden = !distance;
  if (!distance) return;
  drawLegend(byId('legend-bar'));
  byId('legend-title').append('Distance to the surface before');
  byId('legend-low').append('0');
  byId('legend-high').append(shown('page.distance.max', 'length'));
  toggle('error', (on) => {
    view.setErrorColours(on);
    byId('legend').hidden = !on;
  });
}

// The surface before simplification beside what is chosen, each on its side of a line.
function addSplit(view, startSplit) {
  byId('compare').hidden = !hasBefore();
  if (!hasBefore()) return;
  const range = byId('split');
  const move = () => {
    view.setSplit(range.hidden ? null : range.value / 100);
    byId('split-labels').hidden = range.hidden;
    byId('split-labels').style.left = `${range.value}%`;
    range.setAttribute('aria-valuetext', `${range.value} percent of the width`);
  };
  range.addEventListener('input', move);
  toggle('compare', async (on) => {
    range.hidden = !on;
    if (on) await startSplit();
    move();
  });
}

function addOpacity(view) {
  const range = byId('opacity');
  const say = () => range.setAttribute('aria-valuetext', `${range.value} percent`);
  range.addEventListener('input', () => {
    view.setOpacity(range.value / 100);
    say();
  });
  say();
}

const kBackgrounds = { light: 0xf3f5f7, dark: 0x10171d, white: 0xffffff };

// One colour for view and picture; without a choice the view has the page's and the picture has none.
function addBackground(view) {
  const list = byId('background');
  list.addEventListener('change', () => {
    view.canvas.parentElement.dataset.background = list.value;
    view.setBackground(kBackgrounds[list.value] ?? null);
  });
}

function addPicture(view) {
  byId('picture').addEventListener('click', async () => {
    const link = element('a', { download: `${byId('title').textContent}.png` });
    link.href = URL.createObjectURL(await view.picture());
    link.click();
    URL.revokeObjectURL(link.href);
  });
}

function addFullScreen() {
  const button = byId('full');
  button.hidden = !document.fullscreenEnabled;
  button.addEventListener('click', () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else byId('stage').requestFullscreen();
  });
  document.addEventListener('fullscreenchange', () => {
    button.setAttribute('aria-pressed', String(document.fullscreenElement !== null));
  });
}

// `choose` shows a surface by its number, `startSplit` brings in the one before. `several`: surfaces are shown
// together, and `choose` is told whether one of them is on.
export function startControls(view, middle, { several = false, choose, startSplit }) {
  addSurfaces(choose, several);
  toggle('wireframe', (on) => view.setWireframe(on));
  toggle('smooth', (on) => view.setSmooth(on));
  addErrors(view);
  addSplit(view, startSplit);
  addViews(view, space);
  addOpacity(view);
  addBackground(view);
  addPicture(view);
  addFullScreen();
  startSection(view, middle);
  startMeasure(view);
  startMarks(view, byId('marks'), space, unit);
  startKeys(view);
}
