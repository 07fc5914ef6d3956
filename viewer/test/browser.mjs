// A headless Chromium, driven through its DevTools protocol over a pipe: no port, no package.
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const kFolders = (process.env.PATH ?? '').split(':');

// The first of the names that there is, or nothing.
export function findChromium() {
  const names = ['chromium', 'chromium-browser', 'google-chrome'];
  return process.env.CHROMIUM ?? names.flatMap((name) => kFolders.map((folder) => join(folder, name))).find(existsSync);
}

// Processors draw here: WebGL by SwiftShader, and the page itself, which is put together faster without it.
const kFlags = [
  '--headless=new', '--remote-debugging-pipe', '--no-first-run', '--hide-scrollbars', '--force-color-profile=srgb',
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-rasterization',
  '--disable-gpu-compositing', '--disable-background-networking',
  '--disable-component-update', '--disable-extensions', '--disable-dev-shm-usage', '--mute-audio',
];

export class Browser {
  static async start(flags = []) {
    const browser = new Browser();
    browser.folder = await mkdtemp(join(tmpdir(), 'isoweave-browser-'));
    // The sandbox does not work for root.
    const root = process.getuid() === 0 ? ['--no-sandbox'] : [];
    browser.process = spawn(findChromium(), [...kFlags, ...root, ...flags, `--user-data-dir=${browser.folder}`],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    browser.ended = new Promise((resolve) => browser.process.once('exit', resolve));
    browser.listen();
    return browser;
  }

  constructor() {
    this.number = 0;
    this.answers = new Map();
    this.listeners = [];
  }

  listen() {
    let text = '';
    this.process.stdio[4].setEncoding('utf8');
    this.process.stdio[4].on('data', (chunk) => {
      const messages = (text + chunk).split('\0');
      text = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
    this.process.once('exit', (code) => {
      for (const { reject } of this.answers.values()) reject(new Error(`the browser ended with code ${code}`));
    });
  }

  take(message) {
    const answer = this.answers.get(message.id);
    if (answer === undefined) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    this.answers.delete(message.id);
    if (message.error) answer.reject(new Error(`${answer.method}: ${message.error.message}`));
    else answer.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    this.number += 1;
    const id = this.number;
    return new Promise((resolve, reject) => {
      this.answers.set(id, { resolve, reject, method });
      this.process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }

  // { width, height, scale, dark, touch }
  async open(url, screen) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    await page.start(url, screen);
    return page;
  }

  async close() {
    await this.send('Browser.close');
    await this.ended;
    await rm(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Page {
  constructor(browser, session, target) {
    this.browser = browser;
    this.session = session;
    this.target = target;
    this.errors = []; // of the console, and exceptions
    this.requests = []; // addresses
    this.loaded = new Promise((resolve) => browser.listeners.push((message) => {
      if (message.sessionId === session) this.take(message, resolve);
    }));
  }

  take({ method, params }, loaded) {
    if (method === 'Page.loadEventFired') loaded();
    if (method === 'Runtime.exceptionThrown') this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type)) {
      this.errors.push(params.args.map(({ value, description }) => value ?? description).join(' '));
    }
    if (method === 'Log.entryAdded' && params.entry.level === 'error') this.errors.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
  }

  send(method, params) {
    return this.browser.send(method, params, this.session);
  }

  async start(url, { width, height, scale = 1, dark = false, touch = false }) {
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: scale, mobile: touch });
    await this.send('Emulation.setTouchEmulationEnabled', { enabled: touch });
    await this.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
    await this.send('Page.navigate', { url });
    await this.loaded;
    await this.evaluate('window.isoweave?.ready.then(() => undefined)');
    // What the page has filled in has its size then.
    await this.evaluate('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))');
  }

  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  // A press of the mouse in the middle of an element.
  async click(selector) {
    const [x, y] = await this.evaluate(`(() => {
      const found = document.querySelector(${JSON.stringify(selector)});
      found.scrollIntoView({ block: 'center' });
      const box = found.getBoundingClientRect();
      return [box.x + box.width / 2, box.y + box.height / 2];
    })()`);
    for (const type of ['mousePressed', 'mouseReleased']) {
      await this.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', clickCount: 1 });
    }
  }

  async press(key) {
    const codes = { Tab: 9, Enter: 13, ' ': 32, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40 };
    const text = key.length === 1 ? key : undefined;
    const windowsVirtualKeyCode = codes[key] ?? key.toUpperCase().charCodeAt(0);
    await this.send('Input.dispatchKeyEvent', { type: 'keyDown', key, text, windowsVirtualKeyCode });
    await this.send('Input.dispatchKeyEvent', { type: 'keyUp', key, windowsVirtualKeyCode });
  }

  // The whole page, or what is on the screen.
  async screenshot(path, whole = true) {
    await this.evaluate('window.scrollTo(0, 0)');
    const { data } = await this.send('Page.captureScreenshot', { format: 'png', captureBeyondViewport: whole });
    await writeFile(path, Buffer.from(data, 'base64'));
  }

  close() {
    return this.browser.send('Target.closeTarget', { targetId: this.target });
  }
}
