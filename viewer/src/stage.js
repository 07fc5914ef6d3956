// A view in three dimensions: camera, lights and whoever turns them. It is drawn when something has changed, and not
// otherwise.
import { DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Spherical, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const kField = 32; // degrees

// From where something is seen first: a patient from the front, anything else from a corner.
export function firstDirection(space) {
  if (space === 'RAS') return new Vector3(-0.45, 1, 0.22);
  if (space === 'LPS') return new Vector3(0.45, -1, 0.22);
  return new Vector3(0.65, -1, 0.55);
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(kField, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.addLights();
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

  // The whole of a sphere, seen from `direction`.
  lookAt(center, radius, direction) {
    const tightest = Math.min(1, this.camera.aspect);
    const distance = (1.04 * radius) / Math.sin((kField * Math.PI) / 360) / tightest;
    this.camera.position.copy(direction.clone().setLength(distance)).add(center);
    this.camera.near = radius / 200;
    this.camera.far = radius * 60;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.minDistance = radius / 50;
    this.controls.maxDistance = radius * 30;
    this.controls.update();
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
    this.render();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }
}
