// The colours of distances: from the plain surface to a dark red.

const kStops = [[226, 221, 208], [247, 205, 116], [238, 132, 62], [196, 48, 60], [92, 16, 66]];
const kSteps = 256;

function mixed(part) {
  const place = part * (kStops.length - 1);
  const below = Math.min(Math.floor(place), kStops.length - 2);
  return kStops[below].map((value, channel) =>
    Math.round(value + (kStops[below + 1][channel] - value) * (place - below)));
}

// Most distances are small beside the largest: the root tells them apart.
const table = Array.from({ length: kSteps }, (_, step) => mixed(Math.sqrt(step / (kSteps - 1))));

// `part` of the largest distance.
export function errorColour(part) {
  return table[Math.min(kSteps - 1, Math.round(part * (kSteps - 1)))];
}

export function drawLegend(canvas) {
  const context = canvas.getContext('2d');
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = `rgb(${errorColour(x / (canvas.width - 1)).join(' ')})`;
    context.fillRect(x, 0, 1, canvas.height);
  }
}
