// Loads the page of info --isos.
import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { forPeople, inFolder, packages, run, withPage } from './begin.mjs';
import { numberIn } from './numbers.mjs';
import {
  audit, expectFits, expectNumbersOf, kContrasts, kDesktop, kPhone, kSmall, openAll, pressed, settled, visibleText,
} from './pages.mjs';

const kVolume = '<img src=x onerror=alert(1)>.nrrd'; // what a page must not take for its own

const info = (...words) => JSON.parse(run('info', ...words, '--isos', '--json'));

before(() => {
  run('generate', 'noise', '--size', '40', '--type', 'uint8', '-o', kVolume, '--quiet');
  run('generate', 'gyroid', '--size', '32', '--type', 'float32', '-o', 'gyroid.nrrd', '--quiet');
  run('info', kVolume, '--isos', '--html', 'range.html');
  run('info', 'gyroid.nrrd', '--isos', '--html', 'float.html');
  run('info', 'gyroid.nrrd', '--roi', '0:1,0:1,0:1', '--isos', '--html', 'none.html');
});

const plotted = (page) => page.evaluate('window.isoweave.data()');
const legend = (page) => page.evaluate(`[...document.querySelectorAll('.u-value')].map((e) => e.textContent)`);
const values = ({ first, step, vertices }) => vertices.map((_, n) => first + step * n);

describe('the page of info --isos', () => {
  for (const [name, volume] of [['range', kVolume], ['float', 'gyroid.nrrd']]) {
    test(`has the numbers of the JSON: ${name}`, () => withPage(`${name}.html`, kDesktop, async (page) => {
      const report = info(volume);
      assert.ok(report.isos.vertices.length > 200);
      assert.deepEqual(await plotted(page), [values(report.isos), report.isos.vertices.map((count) => 2 * count)]);
      await expectNumbersOf(page, report, 20);
      const rows = await page.evaluate(`[...document.querySelectorAll('#table tbody tr')].map((row) =>
        [...row.children].map((cell) => cell.textContent))`);
      assert.equal(rows.length, report.isos.vertices.length);
      for (const [n, [iso, triangles]] of rows.entries()) {
        assert.ok(Math.abs(numberIn(iso) - values(report.isos)[n]) <= 1e-6 * Math.abs(values(report.isos)[n]), iso);
        assert.equal(numberIn(triangles), 2 * report.isos.vertices[n]);
      }
    }));
  }

  test('tells the value under the pointer', () => withPage('range.html', kDesktop, async (page) => {
    const { isos } = info(kVolume);
    const [x, y, width] = await page.evaluate(`(() => {
      const box = document.querySelector('.u-over').getBoundingClientRect();
      return [box.x, box.y + box.height / 2, box.width];
    })()`);
    for (const part of [0.25, 0.5, 0.75]) {
      await page.send('Input.dispatchMouseEvent', { type: 'mouseMoved', x: x + part * width, y });
      await settled(page);
      const [iso, triangles] = (await legend(page)).map(numberIn);
      const n = values(isos).indexOf(iso);
      assert.ok(n >= 0, `${iso}`);
      assert.ok(Math.abs(n / isos.vertices.length - part) < 0.03, `${n} at ${part}`);
      assert.equal(triangles, 2 * isos.vertices[n]);
    }
  }));

  test('tells the value of the slider, and begins at the suggested one', () => withPage('range.html', kDesktop, async (page) => {
    const { isos, suggested_iso: suggested } = info(kVolume);
    const said = async () => {
      const [, iso, count] = /^--iso (\S+): about (\S+) triangles$/.exec(await visibleText(page, 'chosen'));
      return [numberIn(iso), numberIn(count)];
    };
    const first = Math.round((suggested.otsu - isos.first) / isos.step);
    assert.deepEqual(await said(), [values(isos)[first], 2 * isos.vertices[first]]);
    for (const n of [0, 100, isos.vertices.length - 1]) {
      await page.evaluate(`(() => {
        const range = document.getElementById('iso');
        range.value = ${n};
        range.dispatchEvent(new Event('input'));
      })()`);
      await settled(page);
      assert.deepEqual(await said(), [values(isos)[n], 2 * isos.vertices[n]]);
      assert.deepEqual((await legend(page)).map(numberIn), await said(), 'the chart points there as well');
    }
  }));

  test('has a logarithmic axis', () => withPage('range.html', kDesktop, async (page) => {
    const { isos } = info(kVolume);
    await page.click('#log');
    assert.equal(await pressed(page, 'log'), 'true');
    assert.deepEqual((await plotted(page))[1], isos.vertices.map((count) => 2 * count || null));
    await page.click('#log');
    assert.deepEqual((await plotted(page))[1], isos.vertices.map((count) => 2 * count));
  }));

  test('says that one value has no surface', () => withPage('none.html', kDesktop, async (page) => {
    assert.match(await visibleText(page, 'message'), /one value/);
    for (const id of ['chart', 'choice']) assert.equal(await visibleText(page, id), '', id);
  }));

  for (const dark of [false, true]) {
    test(`${dark ? 'dark' : 'light'}: text stands out, the button turns it over`, () =>
      withPage('range.html', { ...kDesktop, dark }, async (page) => {
        for (const [pair, ratio] of await page.evaluate(kContrasts)) assert.ok(ratio >= 4.5, `${pair}: ${ratio}`);
        assert.equal(await pressed(page, 'theme'), String(dark));
        await page.click('#theme');
        assert.equal(await pressed(page, 'theme'), String(!dark));
        await page.evaluate('localStorage.clear()');
      }));
  }

  for (const name of ['range.html', 'none.html']) {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', kPhone]]) {
      for (const dark of [false, true]) {
        test(`${name} violates no rule of accessibility: ${device}, ${dark ? 'dark' : 'light'}`, () =>
          withPage(name, { ...screen, dark }, async (page) => {
            await openAll(page);
            await audit(page, packages);
          }));
      }
    }
  }

  for (const width of [390, 320, 768, 1320]) {
    test(`fits ${width} pixels`, () => withPage('range.html', { ...kPhone, width }, (page) => expectFits(page, width, 'range')));
  }

  test('every control has a name and is reached by Tab', () => withPage('range.html', kSmall, async (page) => {
    const reached = [];
    for (let presses = 0; presses < 12; ++presses) {
      await page.press('Tab');
      const [id, name] = await page.evaluate(`(() => {
        const e = document.activeElement;
        return [e.id || e.localName, e.getAttribute('aria-label') || e.labels?.[0]?.innerText || e.innerText];
      })()`);
      if (id === 'body') break;
      assert.ok(name.trim(), id);
      reached.push(id);
    }
    assert.deepEqual(reached, ['a', 'theme', 'iso', 'log', 'summary']);
  }));

  test('screenshots', forPeople, async () => {
    for (const [device, screen] of [['desktop', kDesktop], ['phone', { ...kPhone, scale: 1.25 }]]) {
      for (const dark of [false, true]) {
        await withPage('range.html', { ...screen, dark }, (page) =>
          page.screenshot(inFolder(`range-${device}-${dark ? 'dark' : 'light'}.png`)));
      }
    }
  });
});
