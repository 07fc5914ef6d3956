// The surfaces of several iso-values, each of which is shown or not.
import { byId } from './buttons.js';
import { startControls } from './controls.js';
import { packedSurface, report } from './data.js';
import { shown } from './element.js';
import { geometryOf, middleOf, unpack } from './geometry.js';

export class IsoSurfaces {
  constructor(view) {
    this.view = view;
    this.on = report.page.surfaces.map(() => true);
  }

  async start() {
    const parts = [];
    for (const [index, { iso }] of report.page.surfaces.entries()) {
      const surface = await unpack(packedSurface(index));
      this.middle ??= middleOf(surface);
      const { color, opacity } = report.isos[iso];
      parts.push({ geometry: geometryOf(surface, this.middle, 0), color, opacity });
    }
    this.view.setParts(parts);
    startControls(this.view, this.middle, { several: true, choose: (index, on) => this.choose(index, on) });
    this.mark();
  }

  choose(index, on) {
    this.on[index] = on;
    this.mark();
    this.view.showParts(this.on);
  }

  mark() {
    const values = [];
    this.on.forEach((on, index) => {
      byId(`surface-choice-${index}`).checked = on;
      if (on) values.push(values.length > 0 ? ', ' : 'Iso-values ', shown(`isos.${report.page.surfaces[index].iso}.iso`, 'number'));
    });
    byId('drawn').replaceChildren(...(values.length > 0 ? values : ['No surface is shown']));
  }
}
