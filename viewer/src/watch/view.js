// The surface so far: what is final, what is undecided, and where the last slab ended.
import {
  BufferGeometry, DoubleSide, Group, LineBasicMaterial, LineLoop, LineSegments, Mesh, MeshBasicMaterial, Vector3,
} from 'three';
import { firstDirection } from '../directions.js';
import { Stage } from '../stage.js';
import { run } from './news.js';
import { Soup } from './soup.js';

const kEdges = 0.55;

const vectors = (points) => points.map((point) => new Vector3(...point));

export class WatchView extends Stage {
  constructor(canvas) {
    super(canvas);
    this.corners = vectors(run.slices.corners);
    this.between = new Vector3(...run.slices.next).sub(this.corners[0]); // one slice and the next
    this.middle = this.cornersOf((run.slices.count - 1) / 2).reduce((sum, corner) => sum.addScaledVector(corner, 0.25), new Vector3());
    this.strength = { value: kEdges };
    this.final = new Soup(0xffffff, this.strength);
    this.undecided = new Soup(0xffffff, this.strength);
    for (const soup of [this.final, this.undecided]) {
      soup.scale.setScalar(run.grid.step);
      soup.position.set(...run.grid.origin).sub(this.middle);
    }
    this.front = this.makeFront();
    this.frontWanted = true;
    this.setLayer(0);
    this.scene.add(this.final, this.undecided, this.front, this.makeBox());
    this.reset();
  }

  // Of a slice, which may lie before the first or behind the last.
  cornersOf(slice) {
    return this.corners.map((corner) => corner.clone().addScaledVector(this.between, slice));
  }

  // A see-through quadrilateral with its border, where slice 0 is.
  makeFront() {
    const corners = this.corners.map((corner) => corner.clone().sub(this.middle));
    const [a, b, c, d] = corners;
    this.frontLine = new LineBasicMaterial();
    this.frontFill = new MeshBasicMaterial({ transparent: true, opacity: 0.1, side: DoubleSide, depthWrite: false });
    const group = new Group();
    group.add(new LineLoop(new BufferGeometry().setFromPoints(corners), this.frontLine),
      new Mesh(new BufferGeometry().setFromPoints([a, b, c, a, c, d]), this.frontFill));
    return group;
  }

  // Where the volume is.
  makeBox() {
    const low = this.cornersOf(0);
    const high = this.cornersOf(run.slices.count - 1);
    const points = low.flatMap((corner, n) =>
      [corner, low[(n + 1) % 4], high[n], high[(n + 1) % 4], corner, high[n]].map((point) => point.clone().sub(this.middle)));
    this.boxLine = new LineBasicMaterial({ transparent: true, opacity: 0.35 });
    return new LineSegments(new BufferGeometry().setFromPoints(points), this.boxLine);
  }

  // All of the volume.
  lookFrom(direction) {
    const corners = [...this.cornersOf(0), ...this.cornersOf(run.slices.count - 1)];
    this.lookAt(corners.flatMap((corner) => corner.sub(this.middle).toArray()), direction);
  }

  reset() {
    this.lookFrom(firstDirection(run.space));
  }

  // As the style has them, in which light and dark differ.
  setColours() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    this.final.material.color.set(colour('drawn-final'));
    this.undecided.material.color.set(colour('drawn-undecided'));
    for (const material of [this.frontLine, this.frontFill, this.boxLine]) material.color.set(colour('ink'));
    this.draw();
  }

  setEdges(on) {
    this.strength.value = on ? kEdges : 0;
    this.draw();
  }

  setFront(on) {
    this.frontWanted = on;
    this.front.visible = on && this.started;
    this.draw();
  }

  // Layers that are done. A closed surface begins a layer before the first slice.
  setLayer(layer) {
    this.started = layer > 0;
    this.front.visible = this.started && this.frontWanted;
    this.front.position.copy(this.between).multiplyScalar(run.closed ? layer - 1 : layer);
    this.draw();
  }
}
