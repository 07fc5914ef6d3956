// Where the slabs of the sweep ended, in the coordinates of the mesh.
import { Plane, Vector3 } from 'three';
import { report, valueAt } from './data.js';

const kMostPlanes = 48; // more than that hide the mesh

const sweep = report.sweep ?? [];

// Turns x and y where the mesh was written in the other of the two conventions.
function mirrored() {
  const of = valueAt('input.space');
  return (of === 'lps' && report.space === 'RAS') || (of === 'ras' && report.space === 'LPS');
}

function world(i, j, k) {
  const { spacing, origin, direction } = report.input;
  const p = [i * spacing[0], j * spacing[1], k * spacing[2]];
  if (report.space === 'index') return new Vector3(...p);
  const rows = [0, 1, 2].map((row) =>
    origin[row] + direction[3 * row] * p[0] + direction[3 * row + 1] * p[1] + direction[3 * row + 2] * p[2]);
  const sign = mirrored() ? -1 : 1;
  return new Vector3(sign * rows[0], sign * rows[1], rows[2]);
}

// A closed surface begins a layer before the first slice.
const sliceOf = (layer) => (report.closed ? layer - 1 : layer);

export const slabCount = valueAt('input.dims') ? sweep.length : 0;

// The four corners of the slice at which a slab ended.
export function slabCorners(slab) {
  const [nx, ny] = report.input.dims;
  const k = sliceOf(sweep[slab].layer);
  return [world(0, 0, k), world(nx - 1, 0, k), world(nx - 1, ny - 1, k), world(0, ny - 1, k)];
}

// Slabs whose planes are drawn: all, or evenly chosen ones.
export function drawnSlabs() {
  const step = Math.ceil(slabCount / kMostPlanes);
  return sweep.map((_, slab) => slab).filter((slab) => (slabCount - 1 - slab) % step === 0);
}

// Keeps what lies before the end of a slab.
export function cutAfter(slab, middle) {
  const corner = slabCorners(slab)[0];
  const k = sliceOf(sweep[slab].layer);
  const across = world(1, 0, k).sub(corner).cross(world(0, 1, k).sub(corner)).normalize();
  if (across.dot(world(0, 0, k + 1).sub(corner)) > 0) across.negate();
  return new Plane().setFromNormalAndCoplanarPoint(across, corner.sub(middle));
}
