// A plane that cuts the mesh open: across an axis, or where a slab of the sweep ended.
import { Plane, Vector3 } from 'three';
import { byId, toggle } from './buttons.js';
import { space, unit } from './data.js';
import { axisNames } from './directions.js';
import { element, shown } from './element.js';
import { formatted } from './format.js';
import { cutAfter, slabCount } from './slabs.js';

const kSteps = 200; // of the slider along an axis
const kSlabs = 3; // the choice after the three axes

class Section {
  constructor(view, middle) {
    this.view = view;
    this.middle = middle;
    this.range = byId('cut-range');
    this.choice = byId('cut-axis');
    this.addChoices();
    this.choice.addEventListener('change', () => this.begin());
    this.range.addEventListener('input', () => this.update());
    toggle('cut-flip', () => this.update());
    toggle('section', (on) => this.show(on));
  }

  addChoices() {
    const names = [...axisNames(space), ...(slabCount > 0 ? ['Slabs of the sweep'] : [])];
    this.choice.append(...names.map((name, value) => element('option', { value }, name)));
    if (slabCount > 0) this.view.makePlanes(this.middle);
  }

  show(on) {
    byId('cut').hidden = !on;
    if (on) this.begin();
    else this.leave();
  }

  leave() {
    this.view.setPlanes(false);
    this.view.cut(null);
  }

  // In the middle of an axis, or after the last slab.
  begin() {
    this.axis = Number(this.choice.value);
    const slabs = this.axis === kSlabs;
    this.range.min = slabs ? 1 : 0;
    this.range.max = slabs ? slabCount : kSteps;
    this.range.value = slabs ? slabCount : kSteps / 2;
    byId('cut-flip').hidden = slabs;
    this.view.setPlanes(slabs);
    this.update();
  }

  update() {
    if (this.axis === kSlabs) this.cutSlabs();
    else this.cutAcross();
    this.range.setAttribute('aria-valuetext', byId('cut-value').textContent);
  }

  cutAcross() {
    const { min, max } = this.view.box();
    const part = this.range.value / kSteps;
    const at = min.getComponent(this.axis) * (1 - part) + max.getComponent(this.axis) * part;
    const side = byId('cut-flip').getAttribute('aria-pressed') === 'true' ? -1 : 1;
    this.view.cut(new Plane(new Vector3().setComponent(this.axis, -side), side * at));
    byId('cut-value').textContent = `${'xyz'[this.axis]} ${formatted(at + this.middle.getComponent(this.axis), 'length', unit)}`;
  }

  cutSlabs() {
    const slab = Number(this.range.value) - 1;
    this.view.cut(slab === slabCount - 1 ? null : cutAfter(slab, this.middle));
    byId('cut-value').replaceChildren('layer ', shown(`sweep.${slab}.layer`, 'count'));
  }
}

export function startSection(view, middle) {
  return new Section(view, middle);
}
