// Loads the page that isoweave serves while it runs, sees the surface grow, and compares what the page says in the end
// with the report.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { browser, forPeople, inFolder, isoweave, packages } from './begin.mjs';
import { Browser } from './browser.mjs';
import { numberIn } from './numbers.mjs';
import {
  audit, expectKeysOfControls, expectOnFirstScreen, kDesktop, kPhone, kSmall, openAll, reach, settled,
} from './pages.mjs';

const kSlow = 'generate:gyroid:64x64x900:uint8';
const kSlower = 'generate:gyroid:96x96x1600:uint8'; // many seconds, with one thread: the browser is faster
const kLong = 'generate:gyroid:96x96x2000000:uint8';
const kOpen = 'generate:gyroid:96x96x600:uint8'; // with --open most of it is final soon
const kRough = 'generate:white:64x64x256:uint8'; // more triangles than are drawn

const sleep = (ms) => new Promise((done) => { setTimeout(done, ms); });

// A run that is watched. It is killed in the end if it is still there.
class Run {
  constructor(volume, more = []) {
    this.folder = mkdtempSync(join(tmpdir(), 'isoweave-watch-'));
    const words = ['mesh', volume, '--iso', '127.5', '--slab', '8', '-o', 'mesh.ply', '--report', 'mesh.json',
      '--threads', '1', '--watch', ...more];
    this.process = spawn(isoweave, words, { cwd: this.folder, stdio: ['ignore', 'ignore', 'pipe'] });
    this.said = '';
    this.process.stderr.on('data', (text) => { this.said += text; });
    this.ended = new Promise((done) => this.process.once('exit', done));
  }

  async address() {
    for (let tries = 0; tries < 1000; ++tries) {
      const found = /watch at (http:\S+)/.exec(this.said);
      if (found) return found[1];
      await sleep(10);
    }
    throw new Error(`no address: ${this.said}`);
  }

  report() {
    return JSON.parse(readFileSync(join(this.folder, 'mesh.json'), 'utf8'));
  }

  // Nothing goes on, and questions wait, while act does.
  async stopped(act) {
    this.process.kill('SIGSTOP');
    await act();
    this.process.kill('SIGCONT');
  }

  async end() {
    this.process.kill('SIGKILL');
    await this.ended;
    rmSync(this.folder, { recursive: true });
  }
}

async function withWatched(volume, screen, act, { more, errors = [] } = {}) {
  const run = new Run(volume, more);
  const address = await run.address();
  const page = await browser.open(address, screen);
  try {
    await act(page, run);
    assert.deepEqual(page.errors.filter((error) => !errors.some((expected) => expected.test(error))), []);
    for (const url of page.requests) assert.ok(url.startsWith(address) || url.startsWith('data:'), url);
  } finally {
    await page.close();
    await run.end();
  }
}

async function until(page, condition, ms = 60000) {
  for (const end = Date.now() + ms; Date.now() < end;) {
    if (await page.evaluate(condition)) return;
    await sleep(30);
  }
  assert.fail(`never: ${condition}`);
}

const state = (page) => page.evaluate(`document.getElementById('state').dataset.state`);
const kComplete = `document.getElementById('state')?.dataset.state === 'complete'`;
const drawn = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) =>
  ({ final: view.final.triangles, undecided: view.undecided.triangles }))`);
const numbers = (page) => page.evaluate(`Object.fromEntries(['layer', 'layers', 'final', 'undecided', 'live', 'bytes'].map((id) =>
  [id, [Number(document.getElementById(id).dataset.value), document.getElementById(id).textContent]]))`);
const visibleText = (page, id) => page.evaluate(`(() => {
  const e = document.getElementById('${id}');
  return e.offsetHeight > 0 ? e.innerText : '';
})()`);
const pressed = (page, id) => page.evaluate(`document.getElementById('${id}').getAttribute('aria-pressed')`);

// How many pixels have the hue of what is final and of what is undecided, and a sum that changes with the picture.
const picture = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) => {
  view.drawNow();
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [view.canvas.width, view.canvas.height];
  const context = copy.getContext('2d');
  context.drawImage(view.canvas, 0, 0);
  const bytes = context.getImageData(0, 0, copy.width, copy.height).data;
  const seen = { final: 0, undecided: 0, sum: 0 };
  for (let i = 0; i < bytes.length; i += 4) {
    seen.sum = (Math.imul(seen.sum, 31) + (bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2])) | 0;
    if (bytes[i + 2] > bytes[i] + 20) seen.final += 1;
    if (bytes[i] > bytes[i + 2] + 20) seen.undecided += 1;
  }
  return seen;
})`);

describe('a sweep', () => {
  test('is seen while it runs, and ends with the numbers of the report', () => withWatched(kSlower, kSmall, async (page, run) => {
    await until(page, `window.isoweave.news()?.frame > 1 && document.getElementById('state')?.dataset.state === 'running'`);
    await until(page, `window.isoweave.ready.then(({ view }) => view.final.triangles > 2000 && view.undecided.triangles > 500)`);
    let some;
    await run.stopped(async () => {
      const { layer, layers } = await numbers(page);
      assert.ok(layer[0] < layers[0]);
      assert.match(await visibleText(page, 'state'), /^Sweeping/);
      some = await picture(page);
      assert.ok(some.final > 100 && some.undecided > 100, `${some.final} pixels are final, ${some.undecided} undecided`);
    });

    await until(page, kComplete);
    assert.equal(await run.ended, 0, run.said);
    const report = run.report();
    const { sweep } = report;
    const end = await numbers(page);
    assert.deepEqual(Object.fromEntries(Object.entries(end).map(([id, [value]]) => [id, value])), {
      layer: sweep.at(-1).layer, layers: sweep.at(-1).layer, final: report.triangles, undecided: 0,
      live: sweep.at(-1).live_triangles, bytes: sweep.at(-1).bytes,
    });
    for (const [id, [value, text]] of Object.entries(end)) {
      assert.ok(Math.abs(numberIn(text) - value) <= (id === 'bytes' ? value * 0.005 : 0), `${id}: ${value} is shown as '${text}'`);
    }
    assert.deepEqual(await drawn(page), { final: report.triangles, undecided: 0 });
    const said = await visibleText(page, 'state');
    for (const value of [report.triangles.toLocaleString('en-US'), report.vertices.toLocaleString('en-US'), report.digest]) {
      assert.ok(said.includes(value), `${value} in '${said}'`);
    }
    const plots = await page.evaluate('window.isoweave.plotData()');
    assert.deepEqual(plots, {
      layer: sweep.map(({ layer }) => layer), live: sweep.map(({ live_triangles: live }) => live),
      undecided: sweep.map(({ undecided_triangles: undecided }) => undecided),
      final: sweep.map(({ final_triangles: final }) => final), bytes: sweep.map(({ bytes }) => bytes),
    });
    const { final, undecided } = await picture(page);
    assert.ok(final > 2 * some.final && undecided === 0, `${final} pixels are final, ${undecided} undecided`);
    // What is there stays when nobody serves it any more.
    await sleep(1000);
    assert.equal(await state(page), 'complete');
    assert.deepEqual(await drawn(page), { final: report.triangles, undecided: 0 });
  }, { more: ['--error', '1vox'] })); // few enough to be all drawn

  test('that is stopped is said to be', () => withWatched(kLong, kSmall, async (page, run) => {
    await until(page, `window.isoweave.news()?.frame > 1`);
    run.process.kill('SIGINT');
    assert.equal(await run.ended, 130);
    await until(page, `document.getElementById('state')?.dataset.state === 'gone'`);
    assert.match(await visibleText(page, 'state'), /does not answer any more/);
    assert.ok((await drawn(page)).undecided > 0);
  }, { errors: [/ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|ERR_SOCKET_NOT_CONNECTED|ERR_EMPTY_RESPONSE|ERR_INVALID_CHUNKED|ERR_CONTENT_LENGTH/] }));

  test('of more triangles than are drawn is shown coarser, and that is said', () => withWatched(kRough, kSmall, async (page, run) => {
    await until(page, kComplete);
    const { triangles } = run.report();
    const { final } = await drawn(page);
    assert.ok(triangles > 375000 && final < 375000 && final > 10000, `${final} of ${triangles} triangles are drawn`);
    assert.match(await visibleText(page, 'notes'), /final surface is drawn coarser.*375,000/);
    assert.equal((await numbers(page)).final[0], triangles);
  }, { more: ['--error', '0'] }));

  test('is told by numbers where it cannot be drawn', async () => {
    const blind = await Browser.start(['--disable-3d-apis']);
    const run = new Run(kSlow);
    try {
      const page = await blind.open(await run.address(), kSmall);
      await until(page, kComplete);
      assert.match(await visibleText(page, 'view-message'), /no WebGL/);
      assert.equal((await numbers(page)).final[0], run.report().triangles);
    } finally {
      await run.end();
      await blind.close();
    }
  });
});

describe('the view', () => {
  test('changes with its buttons and keys, and back', () => withWatched(kSlow, kSmall, async (page) => {
    await until(page, kComplete);
    await settled(page); // the text of the end makes the frame smaller
    const first = await picture(page);
    for (const [id, key] of [['show-final', 'f'], ['edges', 'w'], ['front', 'p']]) {
      await page.click(`#${id}`);
      assert.equal(await pressed(page, id), 'false');
      assert.notEqual((await picture(page)).sum, first.sum, id);
      await page.press(key);
      assert.equal(await pressed(page, id), 'true');
      assert.equal((await picture(page)).sum, first.sum, `${id} and back`);
    }
    await page.evaluate(`document.getElementById('view').focus()`);
    for (const key of ['ArrowLeft', 'ArrowUp', '+', '-']) {
      await page.press(key);
      assert.notEqual((await picture(page)).sum, first.sum, key);
      await page.press('0');
      assert.equal((await picture(page)).sum, first.sum, `${key} and reset`);
    }
  }, { more: ['--error', '1vox'] })); // few triangles: many pictures

  test('can leave out what is undecided', () => withWatched(kSlower, kSmall, async (page) => {
    await until(page, `window.isoweave.ready.then(({ view }) => view.undecided.triangles > 500)`);
    assert.ok((await picture(page)).undecided > 100);
    await page.press('u');
    assert.equal((await picture(page)).undecided, 0);
  }));
});

describe('looks', () => {
  test('every control has a name and is reached by Tab', () => withWatched(kSlow, kDesktop, async (page) => {
    await until(page, kComplete);
    const reached = [];
    for (let presses = 0; presses < 20; ++presses) {
      await page.press('Tab');
      const [id, name, outline] = await page.evaluate(`(() => {
        const e = document.activeElement;
        const { outlineStyle, outlineWidth } = getComputedStyle(e);
        return [e.id || e.localName, e.getAttribute('aria-label') || e.innerText, outlineStyle === 'solid' && parseFloat(outlineWidth) >= 2];
      })()`);
      if (id === 'body') break;
      assert.ok(name.trim() && outline, `${id} has a name and shows that it has the focus`);
      reached.push(id);
    }
    assert.deepEqual(reached, ['a', 'theme', 'show-final', 'show-undecided', 'front', 'edges', 'views', 'reset', 'view', 'summary', 'summary']);
  }));

  test('numbers of the plots can be read', () => withWatched(kSlow, kDesktop, async (page, run) => {
    await until(page, kComplete);
    await page.click('#plot-triangles summary');
    await until(page, `document.querySelectorAll('#plot-triangles .scroll td').length > 0`);
    const rows = await page.evaluate(`[...document.querySelectorAll('#plot-triangles .scroll tbody tr')].map((row) =>
      [...row.children].map((cell) => cell.textContent))`);
    await run.ended;
    assert.deepEqual(rows.map((row) => row.map(numberIn)), run.report().sweep.map((slab) =>
      [slab.layer, slab.final_triangles, slab.live_triangles, slab.undecided_triangles]));
  }));

  for (const [device, screen] of [['desktop', { width: 1280, height: 800 }], ['phone', kPhone]]) {
    for (const dark of [false, true]) {
      test(`on a ${device}, ${dark ? 'dark' : 'light'}, it violates no rule of accessibility and comes first`, () =>
        withWatched(kSlow, { ...screen, dark }, async (page) => {
          await until(page, kComplete);
          await settled(page);
          assert.equal(await pressed(page, 'theme'), String(dark));
          await expectOnFirstScreen(page);
          await expectKeysOfControls(page);
          const [width, height] = await reach(page);
          assert.ok(width <= 0.92 && height <= 0.92 && Math.max(width, height) > 0.86, `${width} ${height}`);
          await openAll(page);
          await audit(page, packages);
        }));
    }
  }

  for (const width of [320, 390, 768, 1320]) {
    test(`nothing sticks out of ${width} pixels`, () => withWatched(kSlow, { ...kPhone, width }, async (page) => {
      await until(page, kComplete);
      assert.equal(await page.evaluate('document.documentElement.scrollWidth'), width);
      const wide = await page.evaluate(`[...document.querySelectorAll('main *, header *')].filter((e) =>
        !e.closest('.scroll, .u-wrap') && e.getBoundingClientRect().right > ${width} + 0.5).map((e) => e.outerHTML.slice(0, 80))`);
      assert.deepEqual(wide, []);
    }));
  }

  test('screenshots', forPeople, async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        const name = (more) => inFolder(`watch-${device}-${dark ? 'dark' : 'light'}${more}.png`);
        // Runs of their own: a page that is photographed does not ask for news.
        await withWatched(kOpen, { ...screen, dark }, async (page) => {
          await until(page, `window.isoweave.ready.then(({ view }) => view.final.triangles > 20000)`);
          await page.screenshot(name(''));
        }, { more: ['--open'] });
        await withWatched(kOpen, { ...screen, dark }, async (page) => {
          await until(page, kComplete);
          await page.screenshot(name('-complete'));
        }, { more: ['--open'] });
      }
    }
  });
});
