// Bundles a page into one HTML file: node build.mjs page|range|watch OUT.html [FOLDER OF node_modules]
// The file has one mark, where isoweave puts its data in.
import { createHash } from 'node:crypto';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
// What a page has of its own; the rest is that of src/shell.html.
const kFile = {
  about: 'written by isoweave. It needs no server and no network',
  policy: " 'wasm-unsafe-eval'",
  skip: 'numbers',
  footer: '<p>Written by <span id="version">isoweave</span>. This page is one file: no server, no network.</p>',
};
const kPages = {
  page: { ...kFile, main: 'page.html', style: 'style.css', code: 'main.js', uses: ['three', 'meshoptimizer', 'uplot'] },
  range: { ...kFile, policy: '', main: 'range/range.html', style: 'range/range.css', code: 'range/main.js', uses: ['uplot'] },
  watch: {
    about: 'that isoweave serves on this machine while it runs',
    policy: "; connect-src 'self'",
    skip: 'plots',
    footer: '<p>Served by <span id="version">isoweave</span> on this machine only, and until its run ends.</p>',
    main: 'watch/watch.html',
    style: 'watch/watch.css',
    code: 'watch/main.js',
    uses: ['three', 'uplot'],
  },
};
const [wanted, target, packages] = process.argv.slice(2);
if (!(wanted in kPages)) throw new Error(`expected a page of ${Object.keys(kPages).join(', ')}, found '${wanted}'`);
const source = kPages[wanted];
const out = resolve(target ?? join(here, `build/${wanted}.html`));
const modules = resolve(packages ?? join(here, 'node_modules'));
const kLicences = { three: 'LICENSE', meshoptimizer: 'LICENSE.md', uplot: 'LICENSE' };
const esbuild = createRequire(join(modules, 'any.js'))('esbuild');

async function bundle(entry) {
  const result = await esbuild.build({
    entryPoints: [join(here, 'src', entry)],
    nodePaths: [modules],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2021',
    legalComments: 'none',
    charset: 'utf8',
    write: false,
  });
  return result.outputFiles[0].text.trim();
}

// Inside a script element nothing may look like its end, or like the beginning of a comment with a script in it.
function inline(script) {
  return script.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
}

// The licences ask to be where the code is.
async function licences() {
  const texts = await Promise.all(source.uses.map(async (name) => {
    const { version } = JSON.parse(await readFile(join(modules, name, 'package.json'), 'utf8'));
    return `${name} ${version}\n${(await readFile(join(modules, name, kLicences[name]), 'utf8')).trim()}`;
  }));
  return texts.join('\n\n').replaceAll('--', '- -');
}

const [shell, main, style, code] = await Promise.all([
  readFile(join(here, 'src/shell.html'), 'utf8'), readFile(join(here, 'src', source.main), 'utf8'), bundle(source.style),
  bundle(source.code)]);
const script = inline(code);
const hash = createHash('sha256').update(script, 'utf8').digest('base64');
const parts = { ...source, main: main.trim(), style, script, hash, licences: await licences() };
// One pass, and a function: what is put in may contain marks and dollar signs.
const page = shell.replace(/%%(\w+)%%/g, (mark, name) => parts[name] ?? mark);

if (page.split('%%data%%').length !== 2) throw new Error(`${source.main}: expected the mark %%data%% once`);
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
