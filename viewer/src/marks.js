// Marks in the corner of a view: where the axes point, and how long a piece of the picture is.
import { Vector3 } from 'three';
import { axisLetters } from './directions.js';
import { element } from './element.js';
import { formatted } from './format.js';

const kArm = 27; // of the axes, in units of the drawing, which is 88 wide
const kLetter = 36;
const kLongest = 130; // pixels of the scale bar

const svg = (name, attributes) => {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
};

// 1, 2 or 5 times a power of ten, and not above `length`.
export function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((digit) => digit * power <= length) * power;
}

class Marks {
  constructor(view, host, space, unit) {
    this.view = view;
    this.unit = unit;
    this.drawing = svg('svg', { viewBox: '-44 -44 88 88', class: 'axes' });
    this.axes = axisLetters(space).map((letters, axis) => this.addAxis(letters, axis));
    this.bar = element('span', { class: 'scale', title: 'In the plane through the middle of the view' });
    host.append(this.drawing, this.bar);
    view.afterDraw = () => this.update();
    this.update();
  }

  addAxis(letters, axis) {
    const line = svg('line', { class: `axis-${axis}` });
    this.drawing.append(line);
    const ends = letters.map((letter) => {
      const text = svg('text', { class: `axis-${axis}` });
      text.textContent = letter;
      this.drawing.append(text);
      return text;
    });
    return { line, ends };
  }

  update() {
    this.updateAxes();
    this.updateScale();
  }

  // What points away from the reader is fainter.
  updateAxes() {
    const [right, up, towards] = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(this.view.camera.matrixWorld, column));
    this.axes.forEach(({ line, ends }, axis) => {
      const [x, y, z] = [right, up, towards].map((vector) => vector.getComponent(axis));
      const low = ends[0].textContent === '' ? 0 : -kArm;
      Object.entries({ x1: low * x, y1: -low * y, x2: kArm * x, y2: -kArm * y }).forEach(([key, value]) => line.setAttribute(key, value));
      ends.forEach((text, end) => {
        const side = end === 0 ? -1 : 1;
        text.setAttribute('x', side * kLetter * x);
        text.setAttribute('y', -side * kLetter * y);
        text.setAttribute('opacity', side * z < -0.2 ? 0.35 : 1);
      });
    });
  }

  updateScale() {
    const pixel = this.view.unitsPerPixel();
    const length = roundLength(kLongest * pixel);
    this.bar.style.width = `${length / pixel}px`;
    this.bar.textContent = formatted(length, 'length', this.unit);
  }
}

export function startMarks(view, host, space, unit) {
  return new Marks(view, host, space, unit);
}
