// The mesh in three dimensions.
import {
  BufferGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshStandardMaterial,
} from 'three';
import { report, valueAt } from './data.js';
import { cutAfter, drawnSlabs, slabCorners } from './slabs.js';
import { firstDirection, Stage } from './stage.js';

const kPlain = 0xe2ddd0;

export class View extends Stage {
  constructor(canvas) {
    super(canvas);
    this.renderer.localClippingEnabled = true;
    this.surface = new Mesh(new BufferGeometry(), new MeshStandardMaterial({
      color: kPlain, roughness: 0.62, metalness: 0, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    }));
    this.edges = new Mesh(this.surface.geometry, new MeshBasicMaterial({
      wireframe: true, color: 0x16324a, transparent: true, opacity: 0.55,
    }));
    this.wireframe = false;
    this.before = new Mesh(new BufferGeometry(), this.surface.material); // left of the split
    this.beforeEdges = new Mesh(this.before.geometry, this.edges.material);
    this.split = null; // part of the width, or none
    this.planes = new Group();
    this.planes.visible = false;
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

  reset() {
    const { radius, center } = this.surface.geometry.boundingSphere;
    this.lookAt(center, radius, firstDirection(report.space || valueAt('input.space')?.toUpperCase()));
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
    this.surface.material.flatShading = !on;
    this.surface.material.needsUpdate = true;
    this.draw();
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

  // Shows what had been swept after a slab; all of it for null.
  cut(slab, middle) {
    const planes = slab === null ? [] : [cutAfter(slab, middle)];
    this.surface.material.clippingPlanes = planes;
    this.edges.material.clippingPlanes = planes;
    this.draw();
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
    this.surface.visible = !before;
    this.edges.visible = !before && this.wireframe;
    this.before.visible = before;
    this.beforeEdges.visible = before && this.wireframe;
    super.render();
  }
}
