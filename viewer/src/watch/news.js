// What isoweave tells while it runs: JSON with the numbers, then triangles of nine 16-bit coordinates each, on the grid of
// the run.

const kTriangleWords = 9;

export const run = JSON.parse(document.getElementById('run').textContent);

// { numbers, plot, result, frame, frame_layer, final: {..., words}, undecided: {..., words} }
function parsed(buffer) {
  const jsonBytes = new DataView(buffer).getUint32(0, true);
  const news = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, jsonBytes)));
  let place = 4 + jsonBytes;
  for (const part of [news.final, news.undecided]) {
    part.words = new Uint16Array(buffer, place, kTriangleWords * part.triangles);
    place += part.words.byteLength;
  }
  return news;
}

// What has come since: `have` says what this page has already. Throws when nobody answers.
export async function ask(have) {
  const answer = await fetch(`news?bits=${have.bits}&final=${have.final}&frame=${have.frame}`, { cache: 'no-store' });
  if (!answer.ok) throw new Error(`HTTP ${answer.status}`);
  return parsed(await answer.arrayBuffer());
}
