// Loads pages from files, as page.test.mjs does, and looks at, turns, cuts and measures what they draw.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, describe, test } from 'node:test';
import { address, browser, inFolder, json, packages, run, withPage } from './begin.mjs';
import { Browser } from './browser.mjs';
import { numberIn } from './numbers.mjs';
import {
  audit, choose, expectNumbersOf, kPhone, kSmall, picture, pressed, reach, settled, slide, until, visibleText,
} from './pages.mjs';

before(() => {
  run('generate', 'gyroid', '--size', '56', '--type', 'uint8', '--spacing', '0.5,0.5,0.75', '-o', 'volume.nrrd', '--quiet');
  const mesh = (volume, name, ...more) => run('mesh', volume, '--iso', '127.5', '-o', `${name}.ply`, '--html', `${name}.html`,
    '--report', `${name}.json`, '--quiet', ...more);
  mesh('volume.nrrd', 'mesh', '--slab', '12');
  mesh('volume.nrrd', 'large', '--page-triangles', '3000');
  mesh('volume.nrrd', 'levels', '--lods', '0.1vox,0.3vox,1vox');
  run('mesh', 'volume.nrrd', '--iso', '300', '--allow-empty', '-o', 'empty.ply', '--html', 'empty.html', '--quiet');
  run('generate', 'gyroid', '--size', '24', '--type', 'uint8', '-o', 'patient.nrrd', '--quiet');
  const patient = readFileSync(inFolder('patient.nrrd'), 'latin1')
    .replace('space dimension: 3', 'space: left-posterior-superior');
  writeFileSync(inFolder('patient.nrrd'), patient, 'latin1');
  for (const space of ['ras', 'lps']) mesh('patient.nrrd', space, '--space', space);
});

// The middle, width and height of an element on the screen.
const middleOf = (page, selector) => page.evaluate(`(() => {
  const { x, y, width, height } = document.querySelector('${selector}').getBoundingClientRect();
  return [x + width / 2, y + height / 2, width, height];
})()`);

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
    for (const id of ['wireframe', 'smooth', 'error', 'section', 'compare']) {
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
    const move = (percent) => slide(page, 'split', percent);
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
    await page.click('#section');
    await choose(page, 'cut-axis', 3);
    const all = await picture(page);
    const { sweep } = json('mesh.json');
    await slide(page, 'cut-range', 3);
    await settled(page);
    assert.ok((await picture(page)).covered < all.covered);
    assert.equal(await page.evaluate(`document.getElementById('cut-value').textContent`), `layer ${sweep[2].layer}`);
    // The cut is in the plane of the slab's last slice, in the coordinates of the mesh.
    const height = await page.evaluate(`window.isoweave.ready.then(({ view, surfaces }) =>
      view.surface.material.clippingPlanes[0].constant + surfaces.middle.z)`);
    assert.ok(Math.abs(height - (sweep[2].layer - 1) * 0.75) < 1e-9, `${height}`);
  }));

  test('cuts the mesh across its axes, on either side', () => withPage('mesh.html', kSmall, async (page) => {
    const whole = await picture(page);
    await page.click('#section');
    const { low, high } = json('mesh.json').page.check.box;
    for (const axis of [0, 1, 2]) {
      await choose(page, 'cut-axis', axis);
      const sums = new Set([whole.sum]);
      for (const part of [0.25, 0.5]) {
        await slide(page, 'cut-range', 200 * part);
        const said = await page.evaluate(`document.getElementById('cut-value').textContent`);
        const at = low[axis] * (1 - part) + high[axis] * part;
        assert.ok(Math.abs(numberIn(said.slice(2)) - at) < 0.005 * Math.max(1, Math.abs(at)), `${said}: ${at}`);
        assert.equal(said[0], 'xyz'[axis]);
        const kept = await page.evaluate(`window.isoweave.ready.then(({ view, surfaces }) => {
          const [{ normal, constant }] = view.surface.material.clippingPlanes;
          return [normal.toArray(), constant + surfaces.middle.toArray()[${axis}]];
        })`);
        assert.deepEqual(kept[0].map((value) => value || 0), [0, 1, 2].map((n) => (n === axis ? -1 : 0)), 'the lower side is kept');
        assert.ok(Math.abs(kept[1] - at) < 1e-3 * Math.max(1, Math.abs(at)), `${kept[1]}: ${at}`);
        sums.add((await picture(page)).sum);
      }
      await page.click('#cut-flip');
      sums.add((await picture(page)).sum);
      await page.click('#cut-flip');
      assert.equal(sums.size, 4);
    }
    await page.click('#section');
    assert.equal((await picture(page)).sum, whole.sum);
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
    for (const [key, id] of [['w', 'wireframe'], ['s', 'smooth'], ['e', 'error'], ['x', 'section'], ['c', 'compare'], ['m', 'measure']]) {
      const was = await pressed(page, id);
      await page.press(key);
      assert.notEqual(await pressed(page, id), was, key);
    }
    const chosen = () => page.evaluate(`document.querySelector('[name=surface]:checked').value`);
    for (const key of ['1', '2', '4']) {
      await page.press(key);
      assert.equal(await chosen(), String(Number(key) - 1));
    }
  }));

  test('fills its frame, from wherever it is seen', () => withPage('mesh.html', kSmall, async (page) => {
    const views = await page.evaluate(`[...document.getElementById('views').options].map(({ text }) => text)`);
    assert.deepEqual(views, ['View', 'Front', 'Back', 'Left', 'Right', 'Top', 'Bottom']);
    for (const value of ['', '0', '1', '2', '3', '4', '5']) {
      if (value !== '') await choose(page, 'views', value);
      const [width, height] = await reach(page);
      assert.ok(width <= 0.92 && height <= 0.92 && Math.max(width, height) > 0.86, `${views[value]}: ${width} ${height}`);
    }
    const seen = await page.evaluate(`window.isoweave.ready.then(({ view: { camera, controls } }) =>
      camera.position.clone().sub(controls.target).normalize().toArray())`);
    assert.ok(seen[2] < -0.999, 'from the bottom in the end');
    await page.press('0');
    assert.equal(await page.evaluate(`document.getElementById('views').value`), '');
  }));

  test('scrolls under the wheel and a finger, and zooms by the wheel once it was clicked', () =>
    withPage('mesh.html', { ...kPhone, width: 720 }, async (page) => {
      const distance = () => page.evaluate(`window.isoweave.ready.then(({ view }) => view.camera.position.distanceTo(view.controls.target))`);
      const first = await distance();
      const [x, y] = await middleOf(page, '#view');
      const wheel = () => page.send('Input.dispatchMouseEvent', { type: 'mouseWheel', x, y, deltaX: 0, deltaY: 120 });
      await wheel();
      await until(page, 'scrollY > 0');
      assert.equal(await distance(), first);
      await page.evaluate(`scrollTo(0, 0); document.getElementById('view').focus({ preventScroll: true })`);
      await wheel();
      await until(page, `window.isoweave.ready.then(({ view }) => view.camera.position.distanceTo(view.controls.target) > ${first})`);
      assert.equal(await page.evaluate('scrollY'), 0);
      const touch = (type, ...touchPoints) => page.send('Input.dispatchTouchEvent', { type, touchPoints });
      await touch('touchStart', { x, y });
      for (let step = 1; step <= 10; ++step) await touch('touchMove', { x, y: y - 20 * step });
      await touch('touchEnd');
      await until(page, 'scrollY > 0');
    }));

  test('has a line between before and after that can be dragged', () => withPage('mesh.html', kSmall, async (page) => {
    await page.click('#compare');
    await settled(page);
    await page.evaluate('scrollTo(0, 0)');
    const camera = () => page.evaluate(`window.isoweave.ready.then(({ view }) => view.camera.position.toArray())`);
    const was = await camera();
    const both = await picture(page);
    const [x, y, width] = await middleOf(page, '#view');
    for (const [type, to] of [['mousePressed', x], ['mouseMoved', x - width / 8], ['mouseMoved', x - width / 4], ['mouseReleased', x - width / 4]]) {
      await page.send('Input.dispatchMouseEvent', { type, x: to, y, button: 'left', buttons: 1, clickCount: 1 });
    }
    const split = await page.evaluate(`window.isoweave.ready.then(({ view }) => view.split)`);
    assert.ok(Math.abs(split - 0.25) < 0.02, `${split}`);
    assert.deepEqual(await camera(), was, 'and the view is not turned');
    assert.notEqual((await picture(page)).sum, both.sum);
    await page.press('ArrowRight');
    assert.ok(await page.evaluate(`window.isoweave.ready.then(({ view }) => view.split)`) > split);
  }));

  // The first triangle that a ray hits, by the formula of Moeller and Trumbore.
  const kHit = `((view, geometry, x, y) => {
    const position = geometry.attributes.position.array;
    const index = geometry.index.array;
    const minus = (a, b) => a.map((value, n) => value - b[n]);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const along = (z) => view.camera.position.clone().set(x, y, z).unproject(view.camera).toArray();
    const from = along(-1);
    const ray = minus(along(1), from);
    let nearest = Infinity;
    for (let t = 0; t < index.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((n) => [0, 1, 2].map((axis) => position[3 * index[t + n] + axis]));
      const [ab, ac, p] = [minus(b, a), minus(c, a), minus(from, a)];
      const side = cross(ray, ac);
      const area = dot(ab, side);
      const [u, q] = [dot(p, side) / area, cross(p, ab)];
      const [v, at] = [dot(ray, q) / area, dot(ac, q) / area];
      if (u >= 0 && v >= 0 && u + v <= 1 && at > 0) nearest = Math.min(nearest, at);
    }
    return from.map((value, axis) => value + nearest * ray[axis]);
  })`;

  test('measures between two points', () => withPage('mesh.html', kSmall, async (page) => {
    const said = () => visibleText(page, 'measured');
    const plain = await picture(page);
    await page.click('#measure');
    assert.match(await said(), /^Click two points/);
    await page.evaluate('scrollTo(0, 0)');
    const [x, y, width, height] = await middleOf(page, '#view');
    const places = [[-0.2, 0.1], [0.15, -0.25]];
    for (const [right, up] of places) {
      for (const type of ['mousePressed', 'mouseReleased']) {
        await page.send('Input.dispatchMouseEvent', { type, x: x + (right * width) / 2, y: y - (up * height) / 2, button: 'left', clickCount: 1 });
      }
    }
    const [a, b] = await page.evaluate(`window.isoweave.ready.then(({ view }) => ${JSON.stringify(places)}.map(([x, y]) =>
      ${kHit}(view, view.surface.geometry, x, y)))`);
    const expected = Math.hypot(...a.map((value, axis) => value - b[axis]));
    const length = numberIn(await said());
    assert.ok(Math.abs(length - expected) < 0.02 * expected && length > 1, `${length} is ${expected}`);
    assert.match(await said(), / mm apart$/);
    assert.notEqual((await picture(page)).sum, plain.sum, 'the line is drawn');
    await page.evaluate(`document.getElementById('view').focus()`);
    await page.press('Enter');
    assert.match(await said(), /second point/, 'a third one begins anew');
    await page.press('m');
    assert.equal(await said(), '');
    assert.equal((await picture(page)).sum, plain.sum);
  }));

  test('says how long a piece of the picture is', () => withPage('mesh.html', kSmall, async (page) => {
    for (const key of ['', '+', '+', '+', '-', '-', '-', '-', '-']) {
      if (key) await page.press(key);
      await settled(page);
      const [text, pixels, drawn] = await page.evaluate(`window.isoweave.ready.then(({ view: { camera, controls, canvas } }) => {
        const bar = document.querySelector('.scale');
        const length = parseFloat(bar.textContent);
        const right = controls.target.clone().setFromMatrixColumn(camera.matrixWorld, 0);
        const end = controls.target.clone().addScaledVector(right, length).project(camera);
        return [bar.textContent, bar.getBoundingClientRect().width, (end.x * canvas.clientWidth) / 2];
      })`);
      assert.match(text, /^(0\.)?0*[125]0* mm$/);
      assert.ok(Math.abs(pixels - drawn) < 1, `${text}: ${pixels} and ${drawn}`);
    }
  }));

  test('says where a patient’s sides are', async () => {
    for (const [name, ends] of [['ras.html', ['L', 'R']], ['lps.html', ['R', 'L']]]) {
      await withPage(name, kSmall, async (page) => {
        const views = await page.evaluate(`[...document.getElementById('views').options].map(({ text }) => text)`);
        assert.deepEqual(views.slice(1), ['Front (A)', 'Back (P)', 'Left side (L)', 'Right side (R)', 'Top (S)', 'Bottom (I)']);
        await choose(page, 'views', 0);
        await settled(page);
        // Seen from the front, a patient's right is on the left.
        const at = await page.evaluate(`Object.fromEntries([...document.querySelectorAll('.axes text')].map((e) =>
          [e.textContent, [Math.round(e.getAttribute('x')), Math.round(e.getAttribute('y')), Number(e.getAttribute('opacity'))]]))`);
        assert.deepEqual([at.R, at.L, at.S, at.I].map(([x, y]) => [x, y].map((value) => value || 0)), [[-36, 0], [36, 0], [0, -36], [0, 36]]);
        assert.ok(at.A[2] === 1 && at.P[2] < 1, 'what points away is faint');
        const [towards, letters] = await page.evaluate(`window.isoweave.ready.then(({ view: { camera, controls } }) =>
          [camera.position.clone().sub(controls.target).normalize().toArray(), [...document.querySelectorAll('text.axis-0')].map((e) => e.textContent)])`);
        assert.deepEqual(letters, ends, 'from low to high x');
        assert.ok(Math.abs(towards[1] - (name === 'ras.html' ? 1 : -1)) < 0.01);
      });
    }
  });

  test('gives its picture away', () => withPage('mesh.html', kSmall, async (page) => {
    const downloads = inFolder('downloads');
    await browser.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: downloads });
    const [width, height] = await page.evaluate(`[view.clientWidth, view.clientHeight]`);
    const before = await picture(page);
    await page.click('#picture');
    const path = join(downloads, 'mesh.ply.png');
    for (let tries = 0; tries < 500 && !existsSync(path); ++tries) await settled(page);
    const png = readFileSync(path);
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [2 * width, 2 * height]);
    assert.equal((await picture(page)).sum, before.sum);
  }));

  // The least alpha of the pixels that the mesh covers.
  const leastAlpha = (page) => page.evaluate(`window.isoweave.ready.then(({ view }) => {
    view.drawNow();
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [view.canvas.width, view.canvas.height];
    const context = copy.getContext('2d');
    context.drawImage(view.canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    return data.reduce((least, value, at) => (at % 4 === 3 && value > 0 ? Math.min(least, value) : least), 255);
  })`);

  test('lets through as much as the slider says, and back', () => withPage('mesh.html', kSmall, async (page) => {
    const first = await picture(page);
    assert.equal(await page.evaluate(`document.getElementById('opacity').getAttribute('aria-valuetext')`), '100 percent');
    const seen = [];
    for (const value of [70, 30]) {
      await slide(page, 'opacity', value);
      const alpha = await leastAlpha(page);
      // The least of the mesh is one layer of it, or what an edge of a triangle covers of a pixel.
      assert.ok(alpha <= Math.ceil(2.55 * value) + 1, `${alpha} at ${value} percent`);
      assert.equal(await page.evaluate(`document.getElementById('opacity').getAttribute('aria-valuetext')`), `${value} percent`);
      seen.push((await picture(page)).sum);
    }
    assert.equal(new Set([first.sum, ...seen]).size, 3);
    // A surface that is chosen later has it as well, and the one before does.
    await page.click('#compare');
    await settled(page);
    assert.deepEqual(await page.evaluate(`window.isoweave.ready.then(({ view }) => [view.surface, view.before].map(({ material }) =>
      [material.opacity, material.depthWrite]))`), [[0.3, false], [0.3, false]]);
    await page.click('#compare');
    await slide(page, 'opacity', 100);
    await settled(page);
    assert.equal((await picture(page)).sum, first.sum);
  }));

  const kBackgrounds = { light: [243, 245, 247, 255], dark: [16, 23, 29, 255], white: [255, 255, 255, 255], '': [0, 0, 0, 0] };
  for (const dark of [false, true]) {
    test(`has the background that is chosen, with marks that stand out, on a ${dark ? 'dark' : 'light'} page`, () =>
      withPage('mesh.html', { ...kSmall, dark }, async (page) => {
        await page.evaluate(`['error', 'section'].forEach((id) => document.getElementById(id).click())`);
        const first = await picture(page);
        for (const [name, color] of Object.entries(kBackgrounds)) {
          await choose(page, 'background', name);
          const corner = await page.evaluate(`window.isoweave.ready.then(async ({ view }) => {
            const image = await createImageBitmap(await view.picture());
            const copy = document.createElement('canvas');
            [copy.width, copy.height] = [image.width, image.height];
            const context = copy.getContext('2d');
            context.drawImage(image, 0, 0);
            return [...context.getImageData(2, 2, 1, 1).data];
          })`);
          assert.deepEqual(corner, color, name);
          const contrast = await page.evaluate(`(() => {
            const light = (rgb) => {
              const [r, g, b] = rgb.map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
              return 0.2126 * r + 0.7152 * g + 0.0722 * b;
            };
            const ink = (query) => getComputedStyle(document.querySelector(query));
            const inks = [ink('.scale').color, ...[0, 1, 2].map((axis) => ink('text.axis-' + axis).fill)];
            return Math.min(...inks.map((text) => {
              const [low, high] = [light(text.match(/[0-9]+/g).slice(0, 3).map(Number)), light(${JSON.stringify(color)})].sort((a, b) => a - b);
              return (high + 0.05) / (low + 0.05);
            }));
          })()`);
          if (name !== '') assert.ok(contrast >= 4.5, `${name}: ${contrast}`);
          await audit(page, packages);
        }
        assert.equal((await picture(page)).sum, first.sum);
      }));
  }

  test('takes the full screen', () => withPage('mesh.html', kSmall, async (page) => {
    await page.click('#full');
    await settled(page);
    assert.equal(await page.evaluate('document.fullscreenElement?.id'), 'stage');
    assert.equal(await pressed(page, 'full'), 'true');
    await page.click('#full');
    await settled(page);
    assert.equal(await page.evaluate('document.fullscreenElement'), null);
    assert.equal(await pressed(page, 'full'), 'false');
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
