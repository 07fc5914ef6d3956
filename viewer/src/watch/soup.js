// Triangles without common vertices, more of which may come, flat and with their edges.
import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshStandardMaterial } from 'three';

const kFewest = 3 * 4096; // vertices that there is room for at first

// Edges come from the number of a corner: no second set of lines is made each time triangles come.
function addEdges(material, strength) {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.edgeStrength = strength;
    shader.vertexShader = `varying vec3 vCorner;\n${shader.vertexShader}`.replace('#include <begin_vertex>', `
      #include <begin_vertex>
      int corner = gl_VertexID % 3;
      vCorner = vec3(corner == 0 ? 1.0 : 0.0, corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);`);
    // Triangles smaller than some pixels would be all edge.
    shader.fragmentShader = `varying vec3 vCorner;\nuniform float edgeStrength;\n${shader.fragmentShader}`.replace('#include <opaque_fragment>', `
      vec3 pixel = fwidth(vCorner);
      vec3 away = smoothstep(vec3(0.0), 1.3 * pixel, vCorner);
      float edge = 1.0 - min(away.x, min(away.y, away.z));
      float tiny = smoothstep(0.12, 0.45, max(pixel.x, max(pixel.y, pixel.z)));
      outgoingLight *= 1.0 - edgeStrength * edge * (1.0 - tiny);
      #include <opaque_fragment>`);
  };
}

export class Soup extends Mesh {
  // On a grid with steps of one: place and scale are the mesh's. strength: { value } of the edges, 0 to 1.
  constructor(colour, strength) {
    super(new BufferGeometry(), new MeshStandardMaterial({
      color: colour, roughness: 0.7, metalness: 0, side: DoubleSide, flatShading: true,
    }));
    addEdges(this.material, strength);
    this.frustumCulled = false; // would look at all triangles for a sphere
    this.room(kFewest);
    this.clear();
  }

  get triangles() {
    return this.geometry.drawRange.count / 3;
  }

  clear() {
    this.geometry.setDrawRange(0, 0);
  }

  replace(words) {
    this.clear();
    this.append(words);
  }

  // Room for so many vertices; what was there stays.
  room(vertices) {
    const before = this.geometry.attributes.position;
    if (before && before.count >= vertices) return;
    const values = new Float32Array(3 * Math.max(vertices, before ? 2 * before.count : 0));
    if (before) values.set(before.array);
    const { drawRange } = this.geometry;
    this.geometry.dispose();
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(values, 3).setUsage(DynamicDrawUsage));
    this.geometry.setDrawRange(drawRange.start, Number.isFinite(drawRange.count) ? drawRange.count : 0);
  }

  // Corner by corner: nine numbers per triangle.
  append(words) {
    const first = 3 * this.geometry.drawRange.count;
    this.room((first + words.length) / 3);
    const { position } = this.geometry.attributes;
    position.array.set(words, first);
    position.addUpdateRange(first, words.length);
    position.needsUpdate = true;
    this.geometry.setDrawRange(0, (first + words.length) / 3);
  }
}
