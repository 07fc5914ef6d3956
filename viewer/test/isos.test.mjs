// Loads the page of several iso-values, as page.test.mjs does the page of one.
import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { forPeople, inFolder, json, packages, run, withPage } from './begin.mjs';
import {
  audit, choose, expectFits, expectKeysOfControls, expectNumbersOf, expectOnFirstScreen, kDesktop, kOtherDigits, kPhone,
  kSmall, openAll, picture, reach, settled, slide, visibleText,
} from './pages.mjs';

const kVolume = 'generate:smooth:48x48x40:uint8';
const kIsos = [90, 120.5, 150];

before(() => {
  run('mesh', kVolume, '--iso', kIsos.join(','), '-o', 'a.ply', '--html', 'isos.html', '--report', 'isos.json', '--quiet');
  run('mesh', kVolume, '--iso', `400,${kIsos[1]}`, '--allow-empty', '-o', 'b.ply', '--page-triangles', '2000', '--html',
    'few.html', '--report', 'few.json', '--quiet');
});

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
    await slide(page, 'opacity', 50);
    assert.deepEqual((await drawn(page)).map(({ opacity }) => opacity), isos.map(({ opacity }) => opacity / 2));
    assert.deepEqual((await drawn(page)).map(({ clear }) => clear), [true, true, true]);
    await slide(page, 'opacity', 100);
    await page.press('3');
    const left = (await drawn(page)).filter(({ on }) => on);
    assert.deepEqual(left.map(({ clear }) => clear), [true, false], 'the innermost that is shown is opaque');
    assert.equal(await visibleText(page, 'drawn'), 'Iso-values 90, 120.5');
    for (const key of ['1', '2']) await page.press(key);
    await settled(page);
    assert.equal((await picture(page)).covered, 0);
    assert.equal(await visibleText(page, 'drawn'), 'No surface is shown');
  }));

  // The surfaces coincide where they are closed at the border of the volume. The innermost is green there only where it is bare.
  test('covers inner surfaces by outer ones', () => withPage('isos.html', kSmall, async (page) => {
    const green = `window.isoweave.ready.then(({ view }) => {
      view.drawNow();
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [view.canvas.width, view.canvas.height];
      const context = copy.getContext('2d');
      context.drawImage(view.canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      let count = 0;
      for (let at = 0; at < data.length; at += 4) count += data[at + 1] - Math.max(data[at], data[at + 2]) > 60;
      return count;
    })`;
    for (const side of [0, 2, 4]) {
      await choose(page, 'views', side);
      await settled(page);
      const covered = await page.evaluate(green);
      for (const key of ['1', '2']) await page.press(key);
      await settled(page);
      const bare = await page.evaluate(green);
      for (const key of ['1', '2']) await page.press(key);
      assert.ok(bare > 5000 && covered < bare / 200, `${covered} of ${bare}`);
    }
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

  test('screenshots', forPeople, async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        await withPage('isos.html', { ...screen, dark }, (page) =>
          page.screenshot(inFolder(`isos-${device}-${dark ? 'dark' : 'light'}.png`)));
      }
    }
  });
});
