// What a map's cells are painted with.

import { mix } from "./theme.js";

/** Cividis, which is read alike with and without red and green (Nuñez, Anderton & Renslow 2018). */
export const CIVIDIS = [
  "#00224e",
  "#123570",
  "#3b496c",
  "#575d6d",
  "#707173",
  "#8a8678",
  "#a59c74",
  "#c3b369",
  "#e1cc55",
  "#fee838",
].map((hex) => `rgb(${[1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)).join(" ")})`);

export function cividis(part) {
  const at = Math.min(Math.max(part, 0), 1) * (CIVIDIS.length - 1);
  const i = Math.min(Math.floor(at), CIVIDIS.length - 2);
  return mix(CIVIDIS[i], CIVIDIS[i + 1], at - i);
}

/** The hatching, once it is made. */
let pattern = null;

/** Lines across a cell, dark beside light so that they are seen on every colour. */
export function hatch(context) {
  if (!pattern) {
    const tile = Object.assign(document.createElement("canvas"), { width: 6, height: 6 });
    const pen = tile.getContext("2d");
    for (const shift of [0, 1]) {
      pen.strokeStyle = shift ? "rgb(255 255 255 / 0.55)" : "rgb(0 0 0 / 0.55)";
      for (const x of [-6, 0, 6]) {
        pen.beginPath();
        pen.moveTo(x + shift, 6);
        pen.lineTo(x + 6 + shift, 0);
        pen.stroke();
      }
    }
    pattern = context.createPattern(tile, "repeat");
  }
  return pattern;
}

export function rangeOf(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [0, 1];
}

/** A box that is being drawn, from cell to cell. */
export function outlineBox(context, frame, { x, y }, { from, to }, colours) {
  const across = [from[0], to[0]].sort((a, b) => a - b);
  const up = [from[1], to[1]].sort((a, b) => a - b);
  const [w, h] = [frame.width / x.count, frame.height / y.count];
  context.strokeStyle = colours.ink;
  context.setLineDash([5, 3]);
  context.strokeRect(
    frame.left + across[0] * w,
    frame.top + frame.height - (up[1] + 1) * h,
    (across[1] - across[0] + 1) * w,
    (up[1] - up[0] + 1) * h,
  );
  context.setLineDash([]);
}

/** The cell that is pointed at. */
export function outline(context, frame, { x, y }, [i, j], colours) {
  const [w, h] = [frame.width / x.count, frame.height / y.count];
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.strokeRect(frame.left + i * w - 1, frame.top + (y.count - 1 - j) * h - 1, w + 2, h + 2);
}
