// isoweave beside the meshoptimizer of npm, which is newer than that of Debian, and has simplifyWithUpdate.
//
//   npm install meshoptimizer
//   node bench/npm/compare.mjs ISOWEAVE VOLUME OPTIONS...     OPTIONS: those of `isoweave mesh` for the volume, with --iso
//
// The full surface is made first, open at the border of the volume. A line for each share of the triangles that isoweave
// leaves, in one thread, and for each of meshoptimizer's functions at the same count: triangles, RMS distance to the full
// surface, both ways, in terms of isoweave's, and time in terms of isoweave's, the median of three rounds in turn.
// isoweave is native code and is given the number of triangles; its time is that of its simplification. meshoptimizer is
// in WebAssembly, which takes longer than native code does.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { performance } from "node:perf_hooks";
import { pathToFileURL } from "node:url";

const ROUNDS = 3;
const SHARES = [50, 20, 10, 5];

const [isoweave, ...volume] = process.argv.slice(2);
const fromHere = createRequire(join(process.cwd(), "here.js"));
const { MeshoptSimplifier } = await import(pathToFileURL(fromHere.resolve("meshoptimizer")));
await MeshoptSimplifier.ready;
MeshoptSimplifier.useExperimentalFeatures = true; // simplifyWithUpdate is one in some versions

const run = (...options) => execFileSync(isoweave, options, { maxBuffer: 1 << 26, stdio: ["ignore", "pipe", "ignore"] });
const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

/** A binary PLY of isoweave's as arrays: places of three floats, triangles of three indices. */
function readPly(file) {
  const bytes = readFileSync(file);
  const end = bytes.indexOf("end_header\n") + "end_header\n".length;
  const header = bytes.toString("latin1", 0, end);
  const count = (element) => Number(header.match(new RegExp(`element ${element} (\\d+)`))[1]);
  const properties = header.match(/^property float \w+$/gm).join();
  if (properties !== "property float x,property float y,property float z") throw Error(`${file}: expected x, y and z alone`);
  const view = new DataView(bytes.buffer, bytes.byteOffset + end);
  const places = new Float32Array(3 * count("vertex"));
  const triangles = new Uint32Array(3 * count("face"));
  let at = 0;
  for (let n = 0; n < places.length; ++n, at += 4) places[n] = view.getFloat32(at, true);
  for (let n = 0; n < triangles.length; ++n, at += 4) {
    if (n % 3 === 0) at += 1;
    triangles[n] = view.getUint32(at, true);
  }
  return { places, triangles };
}

function writePly(file, { places, triangles }) {
  const header = Buffer.from(
    `ply\nformat binary_little_endian 1.0\nelement vertex ${places.length / 3}\nproperty float x\nproperty float y\n` +
      `property float z\nelement face ${triangles.length / 3}\nproperty list uchar uint vertex_indices\nend_header\n`,
  );
  const body = Buffer.alloc(4 * places.length + (13 * triangles.length) / 3);
  let at = 0;
  for (const x of places) at = body.writeFloatLE(x, at);
  for (let n = 0; n < triangles.length; ++n) {
    if (n % 3 === 0) at = body.writeUInt8(3, at);
    at = body.writeUInt32LE(triangles[n], at);
  }
  writeFileSync(file, Buffer.concat([header, body]));
}

// Each brings a mesh to a number of triangles.
const FUNCTIONS = {
  simplify({ places, triangles }, target) {
    return { places, triangles: MeshoptSimplifier.simplify(triangles, places, 3, 3 * target, 1e9)[0] };
  },
  simplifyWithUpdate({ places, triangles }, target) {
    const none = new Float32Array(0); // vertices have no attributes
    const [length] = MeshoptSimplifier.simplifyWithUpdate(triangles, places, 3, none, 0, [], null, 3 * target, 1e9);
    return { places, triangles: triangles.subarray(0, length) };
  },
};

/** Runs one of meshoptimizer's functions on copies of a mesh, which it may change. */
function theirs(name, { places, triangles }, target, file) {
  const copy = { places: places.slice(), triangles: triangles.slice() };
  const begin = performance.now();
  const mesh = FUNCTIONS[name](copy, target);
  const seconds = (performance.now() - begin) / 1000;
  writePly(file, mesh);
  return { seconds, triangles: mesh.triangles.length / 3 };
}

function ours(full, share, file) {
  const report = `${file}.json`;
  run("simplify", full, "--ratio", `${share}%`, "--threads", "1", "--report", report, "-o", file);
  const { triangles, seconds } = JSON.parse(readFileSync(report));
  return { seconds: seconds.simplify, triangles };
}

const rms = (file, full) => JSON.parse(run("compare", file, full, "--json")).both.rms;

/** Prints what isoweave leaves, and each function in terms of it. A mesh is the same in every round. */
function compare(folder, full, surface, share) {
  const fileOf = (name) => join(folder, `${name}.ply`);
  const names = Object.keys(FUNCTIONS);
  const rounds = Array.from({ length: ROUNDS }, () => {
    const own = ours(full, share, fileOf("isoweave"));
    return { own, others: names.map((name) => theirs(name, surface, own.triangles, fileOf(name))) };
  });
  const { own, others } = rounds[0];
  const ownRms = rms(fileOf("isoweave"), full);
  console.log(`${share} %, isoweave: ${own.triangles} triangles, RMS ${ownRms.toPrecision(3)}`);
  names.forEach((name, n) => {
    const distance = (rms(fileOf(name), full) / ownRms).toFixed(3);
    const time = median(rounds.map((round) => round.others[n].seconds / round.own.seconds)).toFixed(2);
    console.log(`${share} %, ${name}: ${others[n].triangles} triangles, RMS ${distance} times, time ${time} times`);
  });
}

const folder = mkdtempSync(join(tmpdir(), "isoweave-"));
try {
  const full = join(folder, "full.ply");
  run("mesh", ...volume, "--open", "--error", "0", "-o", full);
  const surface = readPly(full);
  for (const share of SHARES) compare(folder, full, surface, share);
} finally {
  rmSync(folder, { recursive: true });
}
