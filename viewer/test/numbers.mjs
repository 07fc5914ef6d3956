// Reads numbers as people write them, by rules of its own: the page's are what is tested.

const kUnits = { B: 1, kB: 1e3, MB: 1e6, GB: 1e9, TB: 1e12, ms: 1e-3, '%': 1e-2 };

// "1,234", "−0.5", "3.2e−5 mm", "66.8 MB", "12 ms", "14 %"
export function numberIn(text) {
  const found = /^\s*([−\d.,e]+)\s*(\S*)/.exec(text);
  if (found === null) return NaN;
  return Number(found[1].replaceAll('−', '-').replaceAll(',', '')) * (kUnits[found[2]] ?? 1);
}
