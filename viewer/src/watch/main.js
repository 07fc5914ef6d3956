// Shows a sweep while it runs: asks isoweave what has come, until the run is complete or nobody answers.
import { byId, startKeys, toggle } from '../buttons.js';
import { element } from '../element.js';
import { fileName, formatted } from '../format.js';
import { startMarks } from '../marks.js';
import { startTheme } from '../theme.js';
import { ask, run } from './news.js';
import { drawPlots, growPlots, plotData, startPlots } from './plots.js';
import { addViews } from '../views.js';
import { WatchView } from './view.js';

const kPause = 150; // ms between two questions
const kTries = 4; // questions without an answer until there is nobody

const have = { bits: 0, final: 0, frame: 0 };
let last; // news
let view;

const count = (value) => formatted(value, 'count');
const sleep = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });

function fillHeading() {
  const [x, y, z] = run.dims.map(count);
  byId('title').textContent = fileName(run.input);
  byId('subtitle').textContent = `${x} × ${y} × ${z} samples at ${formatted(run.iso, 'number')}, into ${fileName(run.output)}`;
  byId('version').textContent = `isoweave ${run.version}`;
  document.title = `${fileName(run.input)} – isoweave`;
}

// A number for people, and exactly.
function put(id, value, format) {
  byId(id).textContent = formatted(value, format);
  byId(id).dataset.value = value;
}

function putNumbers({ layer, layers, final, undecided, live, bytes, seconds, voxels_per_second: speed }) {
  put('layer', layer, 'count');
  put('layers', layers, 'count');
  put('final', final, 'count');
  put('undecided', undecided, 'count');
  put('live', live, 'count');
  put('bytes', bytes, 'bytes');
  put('seconds', seconds, 'seconds');
  byId('speed').textContent = `${formatted(speed / 1e6, 'bare')} Mvoxel/s`;
  byId('progress').value = layers > 0 ? layer / layers : 0;
}

// Said once: screen readers repeat what changes.
function say(state, text) {
  const line = byId('state');
  if (line.dataset.state === state) return;
  line.dataset.state = state;
  line.textContent = text;
}

// False: there is more to be had.
const hasAll = ({ final }) => have.final === final.held;

function sayState(news) {
  const { numbers, result } = news;
  if (result && hasAll(news)) {
    byId('seconds').nextSibling.textContent = ' in all';
    say('complete', `Complete: ${count(result.triangles)} triangles, ${count(result.vertices)} vertices in ` +
      `${formatted(result.seconds, 'seconds')}; digest ${result.digest}`);
  } else if (numbers.layer > 0) {
    say('running', 'Sweeping');
  }
}

const width = (cell) => formatted(cell, 'length', run.unit || 'mm');

// What is drawn is not all there is.
function notesOf({ final, undecided, numbers }) {
  const notes = [];
  if (run.resumed_at > 0) {
    notes.push(`The run went on from layer ${count(run.resumed_at)}: what had become final before is in the file and not in the picture.`);
  }
  if (final.cell > 0) {
    notes.push(`The final surface is drawn coarser than it is, as a page shows ${count(run.most_final)} of its triangles at most: ` +
      `vertices within ${width(final.cell)} are drawn as one. Numbers are those of the surface.`);
  }
  if (undecided.cell > 0 && numbers.undecided > 0) {
    notes.push(`The undecided zone is drawn coarser than it is (${count(run.most_undecided)} triangles at most): vertices within ` +
      `${width(undecided.cell)} are drawn as one.`);
  }
  return notes;
}

function putNotes(news) {
  const notes = notesOf(news);
  const shown = [...byId('notes').children].map(({ textContent }) => textContent);
  if (notes.join('\n') === shown.join('\n')) return;
  byId('notes').replaceChildren(...notes.map((note) => element('li', {}, note)));
  byId('notes').hidden = notes.length === 0;
}

function putTriangles({ frame, frame_layer: layer, final, undecided }) {
  if (final.from === 0) view?.final.clear();
  view?.final.append(final.words);
  if (have.frame !== frame) view?.undecided.replace(undecided.words);
  have.bits = final.bits;
  have.final = final.from + final.triangles;
  have.frame = frame;
  if (!view) return;
  view.setLayer(layer);
  byId('drawn').textContent = layer === 0 ? '' :
    `Drawn at layer ${count(layer)}: ${count(view.final.triangles)} final, ${count(view.undecided.triangles)} undecided`;
}

function take(news) {
  const layer = last?.numbers.layer;
  last = news;
  putNumbers(news.numbers);
  putNotes(news);
  putTriangles(news);
  sayState(news);
  if (news.numbers.layer !== layer) growPlots(news.plot, news.numbers.layers);
}

function sayGone() {
  if (byId('state').dataset.state === 'complete') return;
  say('gone', 'isoweave does not answer any more: its run has ended or was stopped. This is what had come until then.');
}

async function watch(started) {
  for (let tries = 0; tries < kTries;) {
    try {
      take(await ask(have));
      started();
      tries = 0;
      if (last.result && hasAll(last)) return;
      if (hasAll(last)) await sleep(kPause);
    } catch (error) {
      tries += 1;
      await sleep(kPause * 2 ** tries);
    }
  }
  sayGone();
}

function startView() {
  try {
    view = new WatchView(byId('view'));
  } catch (error) {
    byId('view-message').textContent = 'This browser has no WebGL 2 to draw the surface with. The numbers are complete.';
    byId('view-message').hidden = false;
    document.querySelector('.controls').hidden = true;
    return;
  }
  toggle('show-final', (on) => show(view.final, on));
  toggle('show-undecided', (on) => show(view.undecided, on));
  toggle('front', (on) => view.setFront(on));
  toggle('edges', (on) => view.setEdges(on));
  addViews(view, run.space);
  startMarks(view, byId('marks'), run.space, run.unit || 'mm');
  startKeys(view);
}

function show(object, on) {
  object.visible = on;
  view.draw();
}

fillHeading();
startView();
startPlots();
startTheme(() => {
  drawPlots();
  view?.setColours();
});
const ready = new Promise((started) => { watch(started); });
// For tests: the first news have been shown when this is ready.
window.isoweave = { ready: ready.then(() => ({ view })), news: () => last, plotData };
