// From packed surfaces to what is drawn.
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { errorColour } from './colours.js';

const kVertexBytes = 8; // four uint16: x, y, z, distance
const kSteps = 65535;

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// { origin, step, stored: four numbers per vertex, indices, distance }
export async function unpack(packed) {
  await MeshoptDecoder.ready;
  const stored = new Uint16Array(packed.vertices * 4);
  MeshoptDecoder.decodeVertexBuffer(new Uint8Array(stored.buffer), packed.vertices, kVertexBytes, bytesOf(packed.vertex_data));
  const indices = new Uint32Array(packed.triangles * 3);
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(indices.buffer), packed.triangles * 3, 4, bytesOf(packed.index_data));
  return { origin: packed.origin, step: packed.step, distance: packed.distance, stored, indices };
}

// The middle of a surface's box.
export function middleOf(surface) {
  const high = [0, 0, 0];
  for (let i = 0; i < surface.stored.length; ++i) {
    if (i % 4 < 3 && surface.stored[i] > high[i % 4]) high[i % 4] = surface.stored[i];
  }
  return new Vector3(...surface.origin.map((low, axis) => low + (surface.step * high[axis]) / 2));
}

function positions(surface, middle) {
  const count = surface.stored.length / 4;
  const low = surface.origin.map((value, axis) => value - middle.getComponent(axis));
  const values = new Float32Array(count * 3);
  for (let v = 0; v < count; ++v) {
    for (let axis = 0; axis < 3; ++axis) values[3 * v + axis] = low[axis] + surface.step * surface.stored[4 * v + axis];
  }
  return values;
}

// Colours of the distances, the strongest at `largest` and beyond.
function colours(surface, largest) {
  const count = surface.stored.length / 4;
  const values = new Uint8Array(count * 3);
  const scale = largest > 0 ? (surface.distance ?? 0) / kSteps / largest : 0;
  for (let v = 0; v < count; ++v) values.set(errorColour(scale * surface.stored[4 * v + 3]), 3 * v);
  return values;
}

// Around `middle`, so that coordinates far from 0 keep their precision on the graphics card.
export function geometryOf(surface, middle, largestDistance) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions(surface, middle), 3));
  geometry.setAttribute('color', new BufferAttribute(colours(surface, largestDistance), 3, true));
  geometry.setIndex(new BufferAttribute(surface.indices, 1));
  geometry.computeVertexNormals();
  geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  return geometry;
}
