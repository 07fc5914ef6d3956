// The distance between two points of the surface, which are clicked, or taken at the cross in the middle by Enter.
import { BufferGeometry, Line, LineBasicMaterial, Points, PointsMaterial } from 'three';
import { byId, toggle } from './buttons.js';
import { unit } from './data.js';
import { formatted } from './format.js';

const kStill = 5; // pixels that a click may move; more is a turn of the view
const kColour = 0xd4145a;

class Measure {
  constructor(view) {
    this.view = view;
    this.points = [];
    const seenThrough = { color: kColour, depthTest: false, transparent: true };
    this.dots = new Points(new BufferGeometry(), new PointsMaterial({ ...seenThrough, size: 9, sizeAttenuation: false }));
    this.line = new Line(this.dots.geometry, new LineBasicMaterial(seenThrough));
    for (const object of [this.dots, this.line]) {
      object.renderOrder = 2;
      object.frustumCulled = false;
      object.visible = false;
    }
    view.scene.add(this.dots, this.line);
    toggle('measure', (on) => this.turn(on));
    this.listen(view.canvas);
  }

  listen(canvas) {
    let down;
    canvas.addEventListener('pointerdown', (event) => { down = event; });
    canvas.addEventListener('pointerup', (event) => {
      const moved = Math.hypot(event.clientX - down?.clientX, event.clientY - down?.clientY);
      if (this.on && moved <= kStill) this.takeAt(event);
    });
    canvas.addEventListener('keydown', (event) => {
      if (this.on && event.key === 'Enter') this.take(0, 0);
    });
  }

  takeAt({ clientX, clientY }) {
    const { left, top, width, height } = this.view.canvas.getBoundingClientRect();
    this.take((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
  }

  turn(on) {
    this.on = on;
    this.points = [];
    byId('measured').hidden = !on;
    this.view.canvas.parentElement.classList.toggle('measuring', on);
    this.update();
  }

  // A third point begins anew.
  take(x, y) {
    const point = this.view.pointAt(x, y);
    if (!point) return;
    this.points = [...(this.points.length < 2 ? this.points : []), point];
    this.update();
  }

  distance() {
    return this.points.length === 2 ? this.points[0].distanceTo(this.points[1]) : undefined;
  }

  update() {
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry().setFromPoints(this.points);
    this.line.geometry = this.dots.geometry;
    this.dots.visible = this.points.length > 0;
    this.line.visible = this.points.length === 2;
    const asks = ['Click two points of the surface', 'And the second point'];
    byId('measured').textContent = asks[this.points.length] ?? `${formatted(this.distance(), 'length', unit)} apart`;
    this.view.draw();
  }
}

export function startMeasure(view) {
  return new Measure(view);
}
