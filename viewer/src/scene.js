// The mesh in three dimensions. It is drawn when something has changed, and not otherwise.
import {
  BufferGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, Scene, Spherical, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { report, valueAt } from './data.js';
import { cutAfter, drawnSlabs, slabCorners } from './slabs.js';

const kField = 32; // degrees
const kPlain = 0xe2ddd0;

// From where the mesh is seen first: the patient from the front, anything else from a corner.
function firstDirection() {
  const space = report.space || valueAt('input.space')?.toUpperCase();
  if (space === 'RAS') return new Vector3(-0.45, 1, 0.22);
  if (space === 'LPS') return new Vector3(0.45, -1, 0.22);
  return new Vector3(0.65, -1, 0.55);
}

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.localClippingEnabled = true;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(kField, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.addLights();
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
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  // They go with the camera: whatever is looked at is lit.
  addLights() {
    const key = new DirectionalLight(0xffffff, 2.1);
    key.position.set(-0.6, 0.9, 0.7);
    const back = new DirectionalLight(0xbfd4ff, 0.7);
    back.position.set(0.9, -0.4, 0.3);
    this.camera.add(key, back, key.target, back.target);
    key.target.position.set(0, 0, -1);
    back.target.position.set(0, 0, -1);
    this.scene.add(this.camera, new HemisphereLight(0xf4f8ff, 0x8a8378, 0.9));
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
    const tightest = Math.min(1, this.camera.aspect);
    const distance = (1.04 * radius) / Math.sin((kField * Math.PI) / 360) / tightest;
    this.camera.position.copy(firstDirection().setLength(distance)).add(center);
    this.camera.near = radius / 200;
    this.camera.far = radius * 60;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.minDistance = radius / 50;
    this.controls.maxDistance = radius * 30;
    this.controls.update();
    this.draw();
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

  // Angles in radians; zoom above 1 comes nearer.
  orbit(aside, up, zoom = 1) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const turned = new Vector3(offset.x, offset.z, -offset.y); // three's spheres have y up
    const place = new Spherical().setFromVector3(turned);
    place.theta += aside;
    place.phi += up;
    place.makeSafe();
    place.radius = Math.min(Math.max(place.radius / zoom, this.controls.minDistance), this.controls.maxDistance);
    turned.setFromSpherical(place);
    this.camera.position.set(turned.x, -turned.z, turned.y).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.drawNow();
  }

  draw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
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
    this.renderer.render(this.scene, this.camera);
  }
}
