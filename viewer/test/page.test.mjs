// Loads pages that isoweave has just written, from files and without a network, clicks, and compares every number with
// the report:
//   node page.test.mjs ISOWEAVE FOLDER
// Pages and screenshots are left in FOLDER. Ends with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { Browser, findChromium } from './browser.mjs';
import { numberIn } from './numbers.mjs';
import {
  expectFits, expectNumbersOf, kContrasts, kDesktop, kOtherDigits, kPhone, kSmall, picture, pressed, settled, visibleText,
  visit,
} from './pages.mjs';

const [isoweave, folder] = process.argv.slice(2).map((path) => resolve(path));
if (findChromium() === undefined) {
  console.log('skipped: no Chromium in PATH and no CHROMIUM');
  process.exit(77);
}

const kVolume = '<img src=x onerror=alert(1)>.nrrd'; // what a page must not take for its own

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const run = (...words) => execFileSync(isoweave, words, { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] }).toString();
const json = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));
const address = (name) => pathToFileURL(join(folder, name)).href;

let browser;
before(async () => {
  run('generate', 'gyroid', '--size', '56', '--type', 'uint8', '--spacing', '0.5,0.5,0.75', '-o', kVolume, '--quiet');
  run('mesh', kVolume, '--iso', '127.5', '--slab', '12', '-o', 'mesh.ply', '--html', 'mesh.html', '--report',
    'mesh.json', '--quiet');
  run('mesh', kVolume, '--iso', '127.5', '-o', 'large.ply', '--page-triangles', '3000', '--html', 'large.html',
    '--report', 'large.json', '--quiet');
  run('mesh', kVolume, '--iso', '300', '--allow-empty', '-o', 'empty.ply', '--html', 'empty.html', '--report', 'empty.json',
    '--quiet');
  run('simplify', 'mesh.ply', '--triangles', '4000', '-o', 'small.stl', '--html', 'small.html', '--report', 'small.json', '--quiet');
  run('mesh', kVolume, '--iso', '127.5', '-o', 'levels.ply', '--lods', '0.1vox,0.3vox,1vox', '--html', 'levels.html',
    '--report', 'levels.json', '--quiet');
  run('generate', 'gyroid', '--size', '24', '-o', 'indexed.nrrd', '--quiet');
  run('index', 'indexed.nrrd');
  run('mesh', 'indexed.nrrd', '--iso', '0', '--extractor', 'dual', '-o', 'indexed.ply', '--html', 'indexed.html', '--report',
    'indexed.json', '--quiet');
  run('view', 'mesh.ply', '--quiet');
  run('view', 'mesh.json', '-o', 'view.html', '--quiet');
  writeFileSync(join(folder, 'other.json'), JSON.stringify({ ...json('mesh.json'), output: 'small.stl' }));
  run('view', 'other.json', '-o', 'other.html', '--quiet');
  browser = await Browser.start();
});
after(() => browser?.close());

const withPage = (name, screen, act) => visit(browser, address(name), screen, act);

describe('numbers', () => {
  test('of a run on a volume are those of its report', () => withPage('mesh.html', kDesktop, async (page) => {
    const report = json('mesh.json');
    const count = await expectNumbersOf(page, report, 180);
    assert.equal(count('sweep.'), 5 * report.sweep.length);
    for (const [part, keys] of [['seconds.', 5], ['memory.', 2], ['forecast.', 5], ['page.check.', 13], ['page.surfaces.', 8],
      ['page.distance.', 14 + 3 * report.page.distance.bins.length], ['input.', 27]]) assert.equal(count(part), keys, part);
    assert.deepEqual([...new Set(await page.evaluate(kOtherDigits))].sort(), ['0', 'LOD 1', 'LOD 2', 'Layers per slab (0: as it fits)']);
  }));

  const row = (page, label) => page.evaluate(`[...document.querySelectorAll('dt')]
    .filter((e) => e.innerText === '${label}').map((e) => e.nextElementSibling.innerText).join()`);
  test('come with the extractor, and the index where there was one', async () => {
    await withPage('mesh.html', kDesktop, async (page) => {
      assert.equal(await row(page, 'Extractor'), 'cubes');
      assert.equal(await row(page, 'Index'), 'none');
    });
    await withPage('indexed.html', kDesktop, async (page) => {
      const { index } = json('indexed.json');
      assert.equal(await row(page, 'Extractor'), 'dual');
      assert.equal(await row(page, 'Index'), index.path);
      assert.equal(numberIn(await row(page, 'Chunks left out by the index')), index.chunks_left_out);
    });
    await withPage('mesh.ply.html', kDesktop, async (page) => assert.equal(await row(page, 'Index'), '', 'no run'));
  });

  test('of the plots are those of the report', () => withPage('mesh.html', kDesktop, async (page) => {
    const { sweep, page: { distance } } = json('mesh.json');
    const plots = await page.evaluate('window.isoweave.plotData()');
    const column = (key) => sweep.map((record) => record[key] || null);
    assert.deepEqual(plots['plot-triangles'],
      ['layer', 'final_triangles', 'live_triangles', 'undecided_triangles'].map(column));
    assert.deepEqual(plots['plot-memory'], ['layer', 'bytes'].map(column));
    assert.deepEqual(plots['plot-error'], [distance.bins.map(({ from }) => from), distance.bins.map(({ vertices }) => vertices || null)]);
    const vertices = distance.bins.reduce((sum, bin) => sum + bin.vertices, 0);
    assert.equal(vertices, distance.vertices);
  }));

  for (const [name, least] of [['large', 120], ['small', 80], ['empty', 60]]) {
    test(`of ${name} are those of its report`, () => withPage(`${name}.html`, kDesktop, async (page) => {
      await expectNumbersOf(page, json(`${name}.json`), least);
    }));
  }

  test('of a mesh are those of check', () => withPage('mesh.ply.html', kDesktop, async (page) => {
    const check = JSON.parse(run('check', 'mesh.ply', '--json'));
    const surfaces = await page.evaluate(`JSON.parse(document.getElementById('report').textContent).page.surfaces`);
    const notes = await page.evaluate(`JSON.parse(document.getElementById('report').textContent).page.notes`);
    const report = { version: check.version, output: 'mesh.ply', page: { check, surfaces, notes } };
    await expectNumbersOf(page, report, 20);
  }));

  const differing = (page) => page.evaluate(`[...document.querySelectorAll('.differs th')].map((e) => e.innerText)`);
  test('that the file does not have stand out', async () => {
    await withPage('mesh.html', kDesktop, async (page) => assert.deepEqual(await differing(page), []));
    await withPage('other.html', kDesktop, async (page) => {
      assert.deepEqual(await differing(page), ['Triangles', 'Vertices', 'Digest']);
      assert.match(await visibleText(page, 'notes'), /another digest/);
    });
  });

  test('of a report are those of the run', () => withPage('view.html', kDesktop, async (page) => {
    const report = json('mesh.json');
    const { page: made } = await page.evaluate(`JSON.parse(document.getElementById('report').textContent)`);
    assert.deepEqual(made.check, report.page.check);
    await expectNumbersOf(page, { ...report, page: made }, 100);
  }));
});

describe('the view', () => {
  test('shows the mesh', () => withPage('mesh.html', kSmall, async (page) => {
    const { covered, colours } = await picture(page);
    assert.ok(covered > 0.08 && covered < 0.9, `${covered} of the canvas is drawn on`);
    assert.ok(colours > 300, `${colours} colours`);
  }));

  test('has the triangles that the page says', () => withPage('mesh.html', kSmall, async (page) => {
    const { surfaces } = json('mesh.json').page;
    assert.deepEqual(surfaces.map(({ name }) => name), ['full', 'mesh', 'level', 'level']);
    for (const [index, { triangles }] of surfaces.entries()) {
      const drawn = await page.evaluate(`window.isoweave.ready.then(async ({ view, surfaces }) => {
        await surfaces.choose(${index});
        return view.surface.geometry.index.count / 3;
      })`);
      assert.equal(drawn, triangles);
    }
  }));

  test('changes with its buttons, and back', () => withPage('mesh.html', kSmall, async (page) => {
    const first = await picture(page);
    for (const id of ['wireframe', 'smooth', 'error', 'slabs', 'compare']) {
      const was = await pressed(page, id);
      await page.click(`#${id}`);
      assert.notEqual(await pressed(page, id), was, id);
      await settled(page);
      assert.notEqual((await picture(page)).sum, first.sum, id);
      await page.click(`#${id}`);
      assert.equal(await pressed(page, id), was, id);
      await settled(page);
      assert.equal((await picture(page)).sum, first.sum, `${id} and back`);
    }
  }));

  test('names the levels of the run', () => withPage('levels.html', kSmall, async (page) => {
    const names = await page.evaluate(`[...document.querySelectorAll('#surfaces label b')].map((e) => e.innerText)`);
    assert.deepEqual(names, ['Before', 'LOD 0', 'LOD 1', 'LOD 2']);
    assert.equal(await page.evaluate(`document.querySelector('#surfaces input:checked').value`), '3');
    const { levels, triangles } = json('levels.json');
    for (const [index, count] of [...levels.map((level) => level.triangles), triangles].entries()) {
      const drawn = await page.evaluate(`window.isoweave.ready.then(async ({ view, surfaces }) => {
        await surfaces.choose(${index + 1});
        return view.surface.geometry.index.count / 3;
      })`);
      assert.equal(drawn, count);
    }
  }));

  test('switches surfaces', () => withPage('mesh.html', kSmall, async (page) => {
    const sums = new Set();
    for (const index of [0, 1, 2, 3]) {
      await page.click(`label[for=surface-choice-${index}]`);
      await settled(page);
      sums.add((await picture(page)).sum);
      const said = await page.evaluate(`document.getElementById('drawn').textContent`);
      assert.equal(numberIn(said.split(':')[1]), json('mesh.json').page.surfaces[index].triangles);
    }
    assert.equal(sums.size, 4);
  }));

  test('shows before and after on two sides of a line', () => withPage('mesh.html', kSmall, async (page) => {
    const move = (percent) => page.evaluate(`(() => {
      const range = document.getElementById('split-range');
      range.value = ${percent};
      range.dispatchEvent(new Event('input'));
    })()`);
    const after = await picture(page);
    await page.click('label[for=surface-choice-0]');
    await settled(page);
    const first = await picture(page);
    await page.click('label[for=surface-choice-1]');
    await page.click('#compare');
    await settled(page);
    const both = await picture(page);
    assert.ok(both.sum !== after.sum && both.sum !== first.sum);
    await move(100);
    assert.equal((await picture(page)).sum, first.sum, 'all of it before');
    await move(0);
    assert.equal((await picture(page)).sum, after.sum, 'all of it after');
  }));

  test('cuts the mesh where a slab ended', () => withPage('mesh.html', kSmall, async (page) => {
    await page.click('#slabs');
    const all = await picture(page);
    const { sweep } = json('mesh.json');
    await page.evaluate(`(() => {
      const range = document.getElementById('cut-range');
      range.value = 3;
      range.dispatchEvent(new Event('input'));
    })()`);
    await settled(page);
    assert.ok((await picture(page)).covered < all.covered);
    assert.equal(await page.evaluate(`document.getElementById('cut-value').textContent`), `layer ${sweep[2].layer}`);
    // The cut is in the plane of the slab's last slice, in the coordinates of the mesh.
    const height = await page.evaluate(`window.isoweave.ready.then(({ view, surfaces }) =>
      view.surface.material.clippingPlanes[0].constant + surfaces.middle.z)`);
    assert.ok(Math.abs(height - (sweep[2].layer - 1) * 0.75) < 1e-9, `${height}`);
  }));

  test('obeys keys', () => withPage('mesh.html', kSmall, async (page) => {
    await page.evaluate(`document.getElementById('view').focus()`);
    const first = await picture(page);
    for (const key of ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-']) {
      await page.press(key);
      assert.notEqual((await picture(page)).sum, first.sum, key);
      await page.press('0');
      assert.equal((await picture(page)).sum, first.sum, `${key} and reset`);
    }
    for (const [key, id] of [['w', 'wireframe'], ['s', 'smooth'], ['e', 'error'], ['p', 'slabs'], ['c', 'compare']]) {
      const was = await pressed(page, id);
      await page.press(key);
      assert.notEqual(await pressed(page, id), was, key);
    }
    const chosen = () => page.evaluate(`document.querySelector('[name=surface]:checked').value`);
    await page.press('b');
    assert.equal(await chosen(), '0');
    await page.press('b');
    assert.equal(await chosen(), '1');
    await page.press('4');
    assert.equal(await chosen(), '3');
  }));

  test('says that a stand-in is one', () => withPage('large.html', kSmall, async (page) => {
    const { page: { surfaces, notes, check }, triangles } = json('large.json');
    assert.deepEqual(surfaces.map(({ name }) => name).slice(0, 2), ['full', 'stand-in']);
    assert.ok(surfaces[1].triangles <= 3000 && check.triangles === triangles && triangles > 3000);
    assert.match(notes[0], /stand-in/);
    assert.ok((await visibleText(page, 'notes')).includes(notes[0]));
    assert.match(await visibleText(page, 'drawn'), /^Stand-in: /);
  }));

  test('says that an empty mesh is empty', () => withPage('empty.html', kSmall, async (page) => {
    assert.match(await visibleText(page, 'view-message'), /no triangles/);
  }));

  test('says that a browser cannot draw it', async () => {
    const blind = await Browser.start(['--disable-3d-apis']);
    try {
      const page = await blind.open(address('mesh.html'), kSmall);
      assert.match(await visibleText(page, 'view-message'), /no WebGL/);
      await expectNumbersOf(page, json('mesh.json'), 150);
    } finally {
      await blind.close();
    }
  });
});

describe('looks', () => {
  for (const dark of [false, true]) {
    test(`${dark ? 'dark' : 'light'}: text stands out, the button turns it over`, () =>
      withPage('mesh.html', { ...kDesktop, dark }, async (page) => {
        for (const [pair, ratio] of await page.evaluate(kContrasts)) assert.ok(ratio >= 4.5, `${pair}: ${ratio}`);
        const back = () => page.evaluate('getComputedStyle(document.body).backgroundColor');
        const first = await back();
        assert.equal(await pressed(page, 'theme'), String(dark));
        await page.click('#theme');
        assert.equal(await pressed(page, 'theme'), String(!dark));
        assert.notEqual(await back(), first);
        await page.evaluate('localStorage.clear()');
      }));
  }

  for (const width of [390, 320, 768, 1320]) {
    test(`nothing sticks out of ${width} pixels and of its card`, async () => {
      for (const name of ['mesh.html', 'view.html', 'mesh.ply.html', 'empty.html']) {
        await withPage(name, { ...kPhone, width }, async (page) => {
          await expectFits(page, width, name);
        });
      }
    });
  }

  test('every control has a name and is reached by Tab', () => withPage('mesh.html', kDesktop, async (page) => {
    const kName = `((e) => e.getAttribute('aria-label') || e.innerText || e.labels?.[0]?.innerText || '')`;
    const unnamed = await page.evaluate(`[...document.querySelectorAll('button, input, canvas[tabindex], summary')]
      .filter((e) => !${kName}(e).trim()).map((e) => e.id)`);
    assert.deepEqual(unnamed, []);
    const reached = [];
    for (let presses = 0; presses < 20; ++presses) {
      await page.press('Tab');
      const [id, outline] = await page.evaluate(`(() => {
        const e = document.activeElement;
        const ring = e.type === 'radio' ? e.nextElementSibling : e;
        const { outlineStyle, outlineWidth } = getComputedStyle(ring);
        return [e.id || e.localName, outlineStyle === 'solid' && parseFloat(outlineWidth) >= 2];
      })()`);
      if (id === 'body') break;
      assert.ok(outline, `${id} shows that it has the focus`);
      reached.push(id);
    }
    assert.deepEqual(reached, ['a', 'theme', 'view', 'surface-choice-1', 'wireframe', 'smooth', 'error', 'slabs', 'compare', 'reset',
      'summary', 'summary', 'summary']);
  }));

  test('screenshots', async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        await withPage('mesh.html', { ...screen, dark }, async (page) => {
          assert.equal(await pressed(page, 'theme'), String(dark));
          const name = (more) => join(folder, `${device}-${dark ? 'dark' : 'light'}${more}.png`);
          await page.screenshot(name(''));
          for (const id of ['error', 'wireframe', 'slabs']) await page.click(`#${id}`);
          await settled(page);
          await page.screenshot(name('-error'), false);
        });
      }
    }
  });
});
