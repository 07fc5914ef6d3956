// The mesh in three dimensions.
import {
  BufferGeometry, DoubleSide, FrontSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, Raycaster, Vector2,
} from 'three';
import { space } from './data.js';
import { firstDirection } from './directions.js';
import { drawnSlabs, slabCorners } from './slabs.js';
import { Stage } from './stage.js';

const kPlain = 0xe2ddd0;
const kLooked = 20000; // vertices of a surface that a view is fitted to, about
const kPicture = 2; // a picture has so many of its pixels along one of the page, at least

const kNested = 4; // steps of depth between surfaces that coincide, as those of iso-values do at the border of the volume

const plainMaterial = (more = {}) => new MeshStandardMaterial({
  color: kPlain, roughness: 0.62, metalness: 0, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1,
  polygonOffsetUnits: 1, ...more,
});

export class View extends Stage {
  constructor(canvas) {
    super(canvas);
    this.renderer.localClippingEnabled = true;
    this.surface = new Mesh(new BufferGeometry(), plainMaterial());
    this.parts = []; // { surface, edges, opacity } of surfaces that are shown together
    this.edges = new Mesh(this.surface.geometry, new MeshBasicMaterial({
      wireframe: true, color: 0x16324a, transparent: true, opacity: 0.55,
    }));
    this.wireframe = false;
    this.before = new Mesh(new BufferGeometry(), this.surface.material); // left of the split
    this.beforeEdges = new Mesh(this.before.geometry, this.edges.material);
    this.split = null; // part of the width, or none
    this.opacity = 1; // of all surfaces, beside what parts have of their own
    this.planes = new Group();
    this.planes.visible = false;
    this.planesOfCut = [];
    this.scene.add(this.surface, this.edges, this.before, this.beforeEdges, this.planes);
  }

  // The first one also says where to look.
  show(geometry) {
    const first = this.surface.geometry.attributes.position === undefined;
    this.surface.geometry = geometry;
    this.edges.geometry = geometry;
    if (first) this.reset();
    this.draw();
  }

  // Surfaces that are shown together, in place of a single one: { geometry, color, opacity } each. Those that let
  // others be seen are drawn after them, the most transparent last, and lie in front where surfaces coincide.
  setParts(parts) {
    this.parts = parts.map(({ geometry, color, opacity }) => {
      const outer = parts.filter((other) => other.opacity < opacity).length;
      const depth = 1 + kNested * outer;
      const surface = new Mesh(geometry, plainMaterial({ color, polygonOffsetFactor: depth, polygonOffsetUnits: depth }));
      const edges = new Mesh(geometry, this.edges.material);
      surface.renderOrder = -opacity;
      this.scene.add(surface, edges);
      return { surface, edges, opacity };
    });
    this.showParts(parts.map(() => true));
    this.reset();
  }

  // The innermost of those that are shown is opaque, whatever it is among all of them.
  showParts(on) {
    const strongest = Math.max(...this.parts.filter((_, n) => on[n]).map(({ opacity }) => opacity));
    this.parts.forEach((part, n) => {
      part.on = on[n];
      const opaque = part.opacity === strongest;
      part.surface.material.side = opaque ? DoubleSide : FrontSide;
      part.shown = opaque ? 1 : part.opacity;
    });
    this.setOpacity(this.opacity);
  }

  // Surfaces that let others be seen hide nothing of them, so they do not write depths.
  setOpacity(opacity) {
    this.opacity = opacity;
    const set = (material, value) =>
      Object.assign(material, { opacity: value, transparent: value < 1, depthWrite: value === 1, needsUpdate: true });
    set(this.surface.material, opacity);
    for (const { surface, shown } of this.parts) set(surface.material, shown * opacity);
    this.draw();
  }

  // A colour behind all, or null for none.
  setBackground(color) {
    this.renderer.setClearColor(color ?? 0x000000, color === null ? 0 : 1);
    this.draw();
  }

  geometries() {
    return (this.parts.length > 0 ? this.parts.map(({ surface }) => surface) : [this.surface]).map(({ geometry }) => geometry);
  }

  // The box around all that may be shown.
  box() {
    const boxes = this.geometries().map(({ boundingBox }) => boundingBox);
    return boxes.slice(1).reduce((all, box) => all.union(box), boxes[0].clone());
  }

  lookFrom(direction) {
    const points = this.geometries().flatMap(({ attributes: { position: { array } } }) => {
      const step = 3 * Math.ceil(array.length / 3 / kLooked);
      return Array.from({ length: Math.ceil(array.length / step) }, (_, n) => [...array.subarray(n * step, n * step + 3)]).flat();
    });
    this.lookAt(points, direction);
  }

  reset() {
    this.lookFrom(firstDirection(space));
  }

  setWireframe(on) {
    this.wireframe = on;
    this.draw();
  }

  setBefore(geometry) {
    this.before.geometry = geometry;
    this.beforeEdges.geometry = geometry;
  }

  // Shows the surface from before simplification left of this part of the width; nowhere for null.
  setSplit(part) {
    this.split = part;
    this.draw();
  }

  setSmooth(on) {
    for (const material of this.materials()) Object.assign(material, { flatShading: !on, needsUpdate: true });
    this.draw();
  }

  materials() {
    return [this.surface, ...this.parts.map(({ surface }) => surface)].map(({ material }) => material);
  }

  setErrorColours(on) {
    this.surface.material.vertexColors = on;
    this.surface.material.color.set(on ? 0xffffff : kPlain);
    this.surface.material.needsUpdate = true;
    this.draw();
  }

  makePlanes(middle) {
    const points = drawnSlabs().flatMap((slab) => {
      const corners = slabCorners(slab).map((corner) => corner.sub(middle));
      return corners.flatMap((corner, n) => [corner, corners[(n + 1) % corners.length]]);
    });
    this.planes.add(new LineSegments(new BufferGeometry().setFromPoints(points),
      new LineBasicMaterial({ color: 0x1f9aa8, transparent: true, opacity: 0.75 })));
  }

  setPlanes(on) {
    this.planes.visible = on;
    this.draw();
  }

  // Shows what lies in front of a plane; all of it for null.
  cut(plane) {
    this.planesOfCut = plane === null ? [] : [plane];
    for (const material of [...this.materials(), this.edges.material]) material.clippingPlanes = this.planesOfCut;
    this.draw();
  }

  // The point of the surface that is seen at a place of the canvas, from -1 to 1 along both axes; undefined beside it.
  pointAt(x, y) {
    const left = this.split !== null && (x + 1) / 2 < this.split;
    const single = left ? this.before : this.surface;
    const shown = this.parts.length > 0 ? this.parts.filter(({ on }) => on).map(({ surface }) => surface) : [single];
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(x, y), this.camera);
    return ray.intersectObjects(shown, false)
      .find(({ point }) => this.planesOfCut.every((plane) => plane.distanceToPoint(point) >= 0))?.point;
  }

  // A PNG of what is seen, with the background that was chosen, if any.
  async picture() {
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(Math.max(ratio, kPicture));
    this.render();
    const blob = await new Promise((done) => { this.canvas.toBlob(done, 'image/png'); });
    this.renderer.setPixelRatio(ratio);
    this.drawNow();
    return blob;
  }

  render() {
    if (this.split === null) {
      this.drawOne(false);
      return;
    }
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const edge = Math.round(width * this.split);
    this.renderer.setScissorTest(true);
    this.renderer.setScissor(0, 0, edge, height);
    this.drawOne(true);
    this.renderer.setScissor(edge, 0, width - edge, height);
    this.drawOne(false);
    this.renderer.setScissorTest(false);
  }

  drawOne(before) {
    const single = this.parts.length === 0;
    this.surface.visible = single && !before;
    this.edges.visible = single && !before && this.wireframe;
    for (const { surface, edges, on } of this.parts) {
      surface.visible = on;
      edges.visible = on && this.wireframe;
    }
    this.before.visible = before;
    this.beforeEdges.visible = before && this.wireframe;
    super.render();
  }
}
