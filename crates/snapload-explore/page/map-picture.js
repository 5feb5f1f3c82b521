// The saved picture of a map: with its legend beneath, as the picture leaves the page without it.

import { CIVIDIS, hatch } from "./cells.js";
import { fontOf } from "./plot.js";

/** Pixels per point of the picture. */
const FINENESS = 2;
const FONT = fontOf(12.5);
/** Where the rows of the legend begin, the height of each, and the distance of its entries [px]. */
const [LEFT, ROW, GAP] = [56, 22, 16];
const SWATCH = 12;
const BAR = { width: 180, height: 10 };

/**
 * The picture as a PNG file. `paint` draws the map, of this width and height, on a context; each entry of the legend
 * has `words`, and before them its `fill`, hatching if it is `hatched`, or the bar of the colours of numbers and before
 * that the least number, `from`.
 * @param {{ width: number, height: number, colours: any, entries: any[], paint: (context: any) => void }} picture
 * @returns {Promise<Blob>}
 */
export function mapPicture({ width, height, colours, entries, paint }) {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  context.font = FONT;
  const widths = entries.map((entry) => widthOf(context, entry));
  // On a phone the longest words are wider than the map.
  const wide = Math.max(width, LEFT + Math.max(...widths) + GAP / 2);
  const [places, rows] = placed(widths, wide);
  // A change of the size clears the font, too.
  Object.assign(canvas, { width: Math.ceil(wide * FINENESS), height: (height + ROW * rows + 8) * FINENESS });
  context.scale(FINENESS, FINENESS);
  context.fillStyle = colours.panel;
  context.fillRect(0, 0, canvas.width, canvas.height);
  paint(context);
  Object.assign(context, { font: FONT, textBaseline: "middle", textAlign: "left" });
  entries.forEach((entry, i) => drawEntry(context, entry, places[i].x, height + ROW * (places[i].row + 0.5), colours));
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

/** Where entries of these widths are, in rows no longer than the width, and the number of rows. */
function placed(widths, width) {
  let [x, row] = [LEFT, 0];
  const places = widths.map((wide) => {
    if (x > LEFT && x + wide > width) [x, row] = [LEFT, row + 1];
    const place = { x, row };
    x += wide + GAP;
    return place;
  });
  return [places, row + 1];
}

/** The distance between a mark and its words. */
const BESIDE = 6;
/** The parts of an entry from left to right: texts, and the width of its mark. */
function partsOf({ from, fill, hatched, words }) {
  if (from) return [from, BAR.width, words];
  return fill || hatched ? [SWATCH, words] : [words];
}
const sizeOf = (context, part) => (typeof part === "number" ? part : context.measureText(part).width);
const widthOf = (context, entry) =>
  partsOf(entry).reduce((sum, part) => sum + sizeOf(context, part) + BESIDE, -BESIDE);

function drawEntry(context, entry, x, y, colours) {
  for (const part of partsOf(entry)) {
    if (typeof part === "number") drawMark(context, entry, x, y, colours);
    else {
      context.fillStyle = colours.ink;
      context.fillText(part, x, y);
    }
    x += sizeOf(context, part) + BESIDE;
  }
}

function drawMark(context, { from, fill, hatched }, x, y, colours) {
  const [wide, high] = from ? [BAR.width, BAR.height] : [SWATCH, SWATCH];
  /** @type {[number, number, number, number]} */
  const mark = [x, y - high / 2, wide, high];
  context.fillStyle = hatched ? hatch(context) : from ? gradient(context, x) : fill;
  context.fillRect(...mark);
  if (hatched) {
    Object.assign(context, { strokeStyle: colours.edge, lineWidth: 1 });
    context.strokeRect(...mark);
  }
}

function gradient(context, x) {
  const along = context.createLinearGradient(x, 0, x + BAR.width, 0);
  CIVIDIS.forEach((colour, i) => along.addColorStop(i / (CIVIDIS.length - 1), colour));
  return along;
}
