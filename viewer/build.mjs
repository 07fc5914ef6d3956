// Bundles the page into one HTML file: node build.mjs OUT.html [FOLDER OF node_modules]
// The file has one mark, where isoweave puts the report and the mesh in.
import { createHash } from 'node:crypto';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, 'build/page.html'));
const modules = resolve(process.argv[3] ?? join(here, 'node_modules'));
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
  const texts = await Promise.all(Object.entries(kLicences).map(async ([name, file]) => {
    const { version } = JSON.parse(await readFile(join(modules, name, 'package.json'), 'utf8'));
    return `${name} ${version}\n${(await readFile(join(modules, name, file), 'utf8')).trim()}`;
  }));
  return texts.join('\n\n').replaceAll('--', '- -');
}

const [template, style, code] = await Promise.all([
  readFile(join(here, 'src/page.html'), 'utf8'), bundle('style.css'), bundle('main.js')]);
const script = inline(code);
const hash = createHash('sha256').update(script, 'utf8').digest('base64');
const parts = { style, script, hash, licences: await licences() };
// One pass, and a function: what is put in may contain marks and dollar signs.
const page = template.replace(/%%(\w+)%%/g, (mark, name) => parts[name] ?? mark);

if (page.split('%%data%%').length !== 2) throw new Error('src/page.html: expected the mark %%data%% once');
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
