// Loads the page of several iso-values, as page.test.mjs does the page of one:
//   node isos.test.mjs ISOWEAVE FOLDER PACKAGES
// Pages and screenshots are left in FOLDER. Ends with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { Browser, findChromium } from './browser.mjs';
import {
  audit, choose, expectFits, expectKeysOfControls, expectNumbersOf, expectOnFirstScreen, kDesktop, kOtherDigits, kPhone,
  kSmall, openAll, picture, reach, settled, slide, visibleText, visit,
} from './pages.mjs';

const [isoweave, folder, packages] = process.argv.slice(2).map((path) => resolve(path));
if (findChromium() === undefined) {
  console.log('skipped: no Chromium in PATH and no CHROMIUM');
  process.exit(77);
}

const kVolume = 'generate:smooth:48x48x40:uint8';
const kIsos = [90, 120.5, 150];

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const run = (...words) => execFileSync(isoweave, words, { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] }).toString();
const json = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));

let browser;
before(async () => {
  run('mesh', kVolume, '--iso', kIsos.join(','), '-o', 'a.ply', '--html', 'isos.html', '--report', 'isos.json', '--quiet');
  run('mesh', kVolume, '--iso', `400,${kIsos[1]}`, '--allow-empty', '-o', 'b.ply', '--page-triangles', '2000', '--html',
    'few.html', '--report', 'few.json', '--quiet');
  browser = await Browser.start();
});
after(() => browser?.close());

const withPage = (name, screen, act) => visit(browser, pathToFileURL(join(folder, name)).href, screen, act);
const drawn = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) => view.parts.map(({ surface, on }) => ({
  on, triangles: surface.geometry.index.count / 3, opacity: surface.material.opacity, clear: surface.material.transparent,
  colour: '#' + surface.material.color.getHexString() })))`);

describe('the page of several iso-values', () => {
  test('has the numbers of its report', () => withPage('isos.html', kDesktop, async (page) => {
    const report = json('isos.json');
    const count = await expectNumbersOf(page, report, 100);
    assert.equal(count('page.isos.'), 3 * 13);
    assert.equal(count('isos.'), 3 * 3);
    assert.equal(count('page.surfaces.'), 3 * 2);
    assert.deepEqual([...new Set(await page.evaluate(kOtherDigits))], []);
    for (const [iso, value] of kIsos.entries()) {
      const check = JSON.parse(run('check', `a_iso${value}.ply`, '--json'));
      assert.equal(report.page.isos[iso].digest, check.digest);
      assert.equal(report.isos[iso].digest, check.digest);
    }
    assert.deepEqual(await page.evaluate(`[...document.querySelectorAll('.differs')].length`), 0);
  }));

  test('shows all surfaces in their colours, each switched on and off', () => withPage('isos.html', kSmall, async (page) => {
    const { isos } = json('isos.json');
    const all = await drawn(page);
    assert.deepEqual(all.map(({ triangles }) => triangles), isos.map(({ triangles }) => triangles));
    assert.deepEqual(all.map(({ colour }) => colour), isos.map(({ color }) => color));
    assert.deepEqual(all.map(({ opacity }) => opacity), isos.map(({ opacity }) => opacity));
    assert.deepEqual(all.map(({ clear }) => clear), [true, true, false], 'the innermost is opaque');
    const first = await picture(page);
    assert.ok(first.covered > 0.08 && first.colours > 300, JSON.stringify(first));
    const sums = new Set([first.sum]);
    for (const index of [0, 1, 2]) {
      await page.click(`label[for=surface-choice-${index}]`);
      await settled(page);
      assert.deepEqual((await drawn(page)).map(({ on }) => on), [0, 1, 2].map((n) => n !== index));
      sums.add((await picture(page)).sum);
      await page.press(String(index + 1));
      await settled(page);
      assert.equal((await picture(page)).sum, first.sum, `${index} and back, by its key`);
    }
    assert.equal(sums.size, 4, 'each is to be seen');
    await page.press('3');
    const left = (await drawn(page)).filter(({ on }) => on);
    assert.deepEqual(left.map(({ clear }) => clear), [true, false], 'the innermost that is shown is opaque');
    assert.equal(await visibleText(page, 'drawn'), 'Iso-values 90, 120.5');
    for (const key of ['1', '2']) await page.press(key);
    await settled(page);
    assert.equal((await picture(page)).covered, 0);
    assert.equal(await visibleText(page, 'drawn'), 'No surface is shown');
  }));

  test('draws as the page of one surface does', () => withPage('isos.html', kSmall, async (page) => {
    const first = await picture(page);
    for (const id of ['wireframe', 'smooth', 'section']) {
      await page.click(`#${id}`);
      await settled(page);
      assert.notEqual((await picture(page)).sum, first.sum, id);
      await page.click(`#${id}`);
      await settled(page);
      assert.equal((await picture(page)).sum, first.sum, `${id} and back`);
    }
    for (const id of ['error', 'compare']) assert.equal(await visibleText(page, id), '', id);
    await page.click('#section');
    await choose(page, 'cut-axis', 3);
    const all = await picture(page);
    await slide(page, 'cut-range', 1);
    await settled(page);
    const whole = json('isos.json').sweep.length === 1;
    assert.equal((await picture(page)).covered < all.covered, !whole);
  }));

  test('leaves an empty one out, and says that a stand-in is one', () => withPage('few.html', kSmall, async (page) => {
    const report = json('few.json');
    await expectNumbersOf(page, report, 80);
    const [only] = await drawn(page);
    assert.deepEqual(report.page.surfaces.map(({ iso }) => iso), [1]);
    assert.ok(only.triangles <= 2000 && report.isos[1].triangles > 2000);
    assert.match(await visibleText(page, 'notes'), /stand-in/);
    assert.equal(await visibleText(page, 'drawn'), `Iso-values ${kIsos[1]}`);
  }));

  test('fills its frame, on the first screen', () => withPage('isos.html', kPhone, async (page) => {
    await expectOnFirstScreen(page);
    const [width, height] = await reach(page);
    assert.ok(width <= 0.92 && height <= 0.92 && Math.max(width, height) > 0.86, `${width} ${height}`);
    await expectKeysOfControls(page);
  }));

  for (const [device, screen] of [['desktop', kDesktop], ['phone', kPhone]]) {
    for (const dark of [false, true]) {
      test(`violates no rule of accessibility: ${device}, ${dark ? 'dark' : 'light'}`, () =>
        withPage('isos.html', { ...screen, dark }, async (page) => {
          await openAll(page);
          await audit(page, packages);
        }));
    }
  }

  for (const width of [390, 320, 768, 1320]) {
    test(`fits ${width} pixels`, () => withPage('isos.html', { ...kPhone, width }, (page) => expectFits(page, width, 'isos')));
  }

  test('screenshots', async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        await withPage('isos.html', { ...screen, dark }, (page) =>
          page.screenshot(join(folder, `isos-${device}-${dark ? 'dark' : 'light'}.png`)));
      }
    }
  });
});
