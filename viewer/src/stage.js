// A view in three dimensions: camera, lights and whoever turns them. It is drawn when something has changed, and not
// otherwise.
import { DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Spherical, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const kField = 32; // degrees

const kTaken = 0.9; // part of the canvas that is filled, in width or in height

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(kField, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => this.turned());
    this.yieldScrolling();
    this.addLights();
    this.takeSize();
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

  // The page stays scrollable over the canvas: the wheel zooms once the canvas has been clicked, or with Ctrl, and a
  // finger that moves up or down scrolls. On the full screen there is nothing to scroll.
  yieldScrolling() {
    const alone = () => document.fullscreenElement?.contains(this.canvas) ?? false;
    this.canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas && !alone()) event.stopImmediatePropagation();
    }, { capture: true });
    const setTouch = () => { this.canvas.style.touchAction = alone() ? 'none' : 'pan-y'; };
    document.addEventListener('fullscreenchange', setTouch);
    setTouch();
  }

  // The nearest view from `direction` that shows all of the points: x, y, z of each after the last. On each axis of the
  // canvas two of them touch its margins, or would with more room: their distances give the place of the camera.
  lookAt(points, direction) {
    this.fit = () => this.lookAt(points, direction); // again when the canvas gets another size, until it is turned
    const towards = direction.clone().normalize();
    const right = new Vector3().crossVectors(this.camera.up, towards).normalize();
    const up = new Vector3().crossVectors(towards, right);
    const slopeUp = kTaken * Math.tan((kField * Math.PI) / 360);
    const slopes = [slopeUp * this.camera.aspect, slopeUp];
    const edges = [[-Infinity, -Infinity], [-Infinity, -Infinity]];
    const depth = [Infinity, -Infinity];
    const point = new Vector3();
    for (let at = 0; at < points.length; at += 3) {
      const z = point.fromArray(points, at).dot(towards);
      depth[0] = Math.min(depth[0], z);
      depth[1] = Math.max(depth[1], z);
      [right, up].forEach((axis, n) => {
        const side = point.dot(axis) / slopes[n];
        edges[n][0] = Math.max(edges[n][0], z - side);
        edges[n][1] = Math.max(edges[n][1], z + side);
      });
    }
    const middle = (depth[0] + depth[1]) / 2;
    const [aside, upwards] = edges.map(([low, high], n) => (slopes[n] * (high - low)) / 2);
    const distance = Math.max(...edges.map(([low, high]) => (low + high) / 2)) - middle;
    const target = towards.clone().multiplyScalar(middle).addScaledVector(right, aside).addScaledVector(up, upwards);
    this.placeCamera(target, towards, distance || 1);
  }

  placeCamera(target, towards, distance) {
    this.camera.position.copy(target).addScaledVector(towards, distance);
    this.camera.near = distance / 500;
    this.camera.far = distance * 40;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.minDistance = distance / 100;
    this.controls.maxDistance = distance * 12;
    this.controls.update();
    this.draw();
  }

  // In the plane through the point that the camera turns around.
  unitsPerPixel() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((kField * Math.PI) / 360)) / this.canvas.clientHeight;
  }

  // By a hand, from the view that was chosen.
  turned() {
    this.fit = undefined;
    this.onTurn?.();
  }

  // Angles in radians; zoom above 1 comes nearer.
  orbit(aside, up, zoom = 1) {
    this.turned();
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

  // False where there is no room yet.
  takeSize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return false;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    return true;
  }

  resize() {
    if (!this.takeSize()) return;
    this.fit?.();
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
    this.afterDraw?.();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }
}
