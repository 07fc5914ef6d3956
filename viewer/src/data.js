// What isoweave put into the page.

const json = (id) => JSON.parse(document.getElementById(id)?.textContent ?? 'null');

export const report = json('report');

// The packed surface that belongs to report.page.surfaces[index].
export const packedSurface = (index) => json(`surface-${index}`);

// The value of a key such as "input.dims.0", or undefined.
export function valueAt(key) {
  return key.split('.').reduce((value, part) => value?.[part], report);
}

// The unit of lengths. Where neither the volume nor the mesh says, it is millimetres.
export const unit = valueAt('input.unit') || valueAt('page.check.unit') || 'mm';

// "RAS", "LPS" or "INDEX", or nothing.
export const space = (report?.space || valueAt('input.space'))?.toUpperCase();
