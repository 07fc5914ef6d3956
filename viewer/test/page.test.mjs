// Loads pages that isoweave has just written, from files and without a network, clicks, and compares every number with
// the report.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { before, describe, test } from 'node:test';
import { forPeople, inFolder, json, packages, run, withPage } from './begin.mjs';
import { numberIn } from './numbers.mjs';
import {
  audit, expectFits, expectKeysOfControls, expectNumbersOf, expectOnFirstScreen, kContrasts, kDesktop, kOtherDigits, kPhone,
  openAll, pressed, settled, visibleText,
} from './pages.mjs';

const kVolume = '<img src=x onerror=alert(1)>.nrrd'; // what a page must not take for its own

before(() => {
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
  writeFileSync(inFolder('other.json'), JSON.stringify({ ...json('mesh.json'), output: 'small.stl' }));
  run('view', 'other.json', '-o', 'other.html', '--quiet');
});

describe('numbers', () => {
  test('of a run on a volume are those of its report', () => withPage('mesh.html', kDesktop, async (page) => {
    const report = json('mesh.json');
    const count = await expectNumbersOf(page, report, 180);
    assert.equal(count('sweep.'), 5 * report.sweep.length);
    for (const [part, keys] of [['seconds.', 5], ['memory.', 2], ['forecast.', 5], ['page.check.', 16], ['page.surfaces.', 8],
      ['page.distance.', 14 + 3 * report.page.distance.bins.length], ['input.', 26]]) assert.equal(count(part), keys, part);
    assert.deepEqual([...new Set(await page.evaluate(kOtherDigits))].sort(), ['0', 'Coarser 1', 'Coarser 2', 'Edges on a border (0: closed)']);
  }));

  const row = (page, label) => page.evaluate(`[...document.querySelectorAll('dt')]
    .filter((e) => e.textContent === '${label}').map((e) => e.nextElementSibling.textContent).join()`);
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

  const differing = (page) => page.evaluate(`[...document.querySelectorAll('.differs th')].map((e) => e.textContent)`);
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

  for (const name of ['mesh.html', 'mesh.ply.html', 'empty.html', 'large.html', 'levels.html']) {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', kPhone]]) {
      for (const dark of [false, true]) {
        test(`${name} on a ${device}, ${dark ? 'dark' : 'light'}, violates no rule of accessibility`, () =>
          withPage(name, { ...screen, dark }, async (page) => {
            assert.equal(await pressed(page, 'theme'), String(dark));
            await audit(page, packages);
            await openAll(page);
            await page.evaluate(`['error', 'compare', 'section', 'measure'].map((id) => document.getElementById(id))
              .filter((button) => button.offsetHeight > 0).forEach((button) => button.click())`);
            await settled(page);
            await audit(page, packages);
          }));
      }
    }
  }

  for (const [device, screen] of [['desktop', { width: 1280, height: 800 }], ['phone', kPhone]]) {
    test(`mesh and controls are on the first screen of a ${device}`, () => withPage('mesh.html', screen, expectOnFirstScreen));
  }

  test('the keys that are named are those of the controls', async () => {
    for (const name of ['mesh.html', 'mesh.ply.html', 'levels.html']) await withPage(name, kDesktop, expectKeysOfControls);
  });

  test('the histogram comes first, and the sweep is folded away', () => withPage('mesh.html', kDesktop, async (page) => {
    const shown = await page.evaluate(`[...document.querySelectorAll('.plots .card')].map((e) => [e.id, e.checkVisibility()])`);
    assert.deepEqual(shown, [['plot-error', true], ['plot-triangles', false], ['plot-memory', false]]);
    await page.click('#experts > summary');
    await settled(page);
    const wide = await page.evaluate(`[...document.querySelectorAll('#sweep-plots .u-over')].map((e) => e.clientWidth > 100)`);
    assert.deepEqual(wide, [true, true]);
  }));

  test('every control has a name and is reached by Tab', () => withPage('mesh.html', kDesktop, async (page) => {
    const kName = `((e) => e.getAttribute('aria-label') || e.textContent || e.labels?.[0]?.textContent || '')`;
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
    assert.deepEqual(reached, ['a', 'theme', 'surface-choice-1', 'compare', 'error', 'wireframe', 'smooth', 'section', 'measure',
      'views', 'background', 'opacity', 'reset', 'picture', 'full', 'view', 'summary', 'summary']);
  }));

  test('screenshots', forPeople, async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        await withPage('mesh.html', { ...screen, dark }, async (page) => {
          const name = (more) => inFolder(`${device}-${dark ? 'dark' : 'light'}${more}.png`);
          await page.screenshot(name(''));
          for (const id of ['error', 'wireframe', 'section', 'compare']) await page.click(`#${id}`);
          await settled(page);
          await page.screenshot(name('-error'), false);
        });
      }
    }
  });
});
