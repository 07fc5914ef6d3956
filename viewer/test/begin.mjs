// The beginning of the tests of pages: a folder of their own, the program, a browser.
//   node NAME.test.mjs ISOWEAVE FOLDER PACKAGES
// Pages are left in FOLDER, with ISOWEAVE_SCREENSHOTS=1 pictures of them, too: these take minutes, and only people look at
// them. Ends with 77 where there is no Chromium.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';
import { Browser, findChromium } from './browser.mjs';
import { visit } from './pages.mjs';

export const [isoweave, folder, packages] = process.argv.slice(2).map((path) => resolve(path));
if (findChromium() === undefined) {
  console.log('skipped: no Chromium in PATH and no CHROMIUM');
  process.exit(77);
}
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

export let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser?.close());

// Options of tests that only take pictures.
export const forPeople = { skip: process.env.ISOWEAVE_SCREENSHOTS === undefined && 'ISOWEAVE_SCREENSHOTS is not set' };

export const inFolder = (name) => join(folder, name);
export const run = (...words) => execFileSync(isoweave, words, { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] }).toString();
export const json = (name) => JSON.parse(readFileSync(inFolder(name), 'utf8'));
export const address = (name) => pathToFileURL(inFolder(name)).href;
export const withPage = (name, screen, act) => visit(browser, address(name), screen, act);
