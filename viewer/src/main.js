// Puts the page together.
import { markSurface, resultIndex, startControls } from './controls.js';
import { packedSurface, report } from './data.js';
import { geometryOf, middleOf, unpack } from './geometry.js';
import { IsoSurfaces } from './isos.js';
import { drawPlots, plotData, startPlots } from './plots.js';
import { View } from './scene.js';
import { fillCards, fillHeading, fillNotes, fillTiles } from './tables.js';
import { startTheme } from './theme.js';

function say(text) {
  const message = document.getElementById('view-message');
  message.textContent = text;
  message.hidden = text === '';
}

function hideControls() {
  document.querySelector('.controls').hidden = true;
}

// Surfaces are unpacked when they are first looked at.
class Surfaces {
  constructor(view) {
    this.view = view;
    this.shown = resultIndex();
    this.geometries = new Map();
  }

  async start() {
    const first = await unpack(packedSurface(this.shown));
    this.middle = middleOf(first);
    this.keep(this.shown, first);
    startControls(this.view, this.middle, {
      choose: (index) => this.choose(index),
      startSplit: async () => this.view.setBefore(await this.geometry(0)),
    });
    await this.choose(this.shown);
  }

  keep(index, surface) {
    this.geometries.set(index, geometryOf(surface, this.middle, report.page.distance?.max ?? 0));
  }

  async geometry(index) {
    if (!this.geometries.has(index)) this.keep(index, await unpack(packedSurface(index)));
    return this.geometries.get(index);
  }

  async choose(index) {
    this.shown = index;
    markSurface(index);
    const geometry = await this.geometry(index);
    if (this.shown === index) this.view.show(geometry);
  }
}

async function startView() {
  if (report.page.surfaces.length === 0) {
    say('The mesh has no triangles: there is nothing to draw.');
    hideControls();
    return undefined;
  }
  let view;
  try {
    view = new View(document.getElementById('view'));
  } catch (error) {
    say('This browser has no WebGL 2 to draw the mesh with. The numbers are complete.');
    hideControls();
    return undefined;
  }
  const surfaces = report.isos ? new IsoSurfaces(view) : new Surfaces(view);
  await surfaces.start();
  return { view, surfaces };
}

fillHeading();
fillTiles();
fillNotes();
fillCards();
startPlots();
startTheme(drawPlots);
// For tests: the page is complete when this is.
window.isoweave = { plotData, ready: startView() };
