// The colours and hatching of a map's cells.

import { Frame, drawAxes, fontOf, inside, label, ticks } from "./plot.js";
import { mix } from "./theme.js";
import { withSymbols, unitText } from "./formatting.js";

const MARGIN = { left: 56, right: 12, top: 10, bottom: 40 };
/** Larger than in the small charts. */
const [NUMBERS, LETTERS] = [fontOf(13), fontOf(14)];

/** Cividis, which looks the same with and without red-green colour vision (Nuñez, Anderton & Renslow 2018). */
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

/** The hatching, made when it is first needed. */
let pattern = null;

/** Lines across a cell, dark next to light so that they are visible on every colour. */
export function hatch(target) {
  if (!pattern) {
    const tile = Object.assign(document.createElement("canvas"), { width: 6, height: 6 });
    const context = tile.getContext("2d");
    for (const shift of [0, 1]) {
      context.strokeStyle = shift ? "rgb(255 255 255 / 0.55)" : "rgb(0 0 0 / 0.55)";
      for (const x of [-6, 0, 6]) {
        context.beginPath();
        context.moveTo(x + shift, 6);
        context.lineTo(x + 6 + shift, 0);
        context.stroke();
      }
    }
    pattern = target.createPattern(tile, "repeat");
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

/** The selection box that is being drawn, from cell to cell. */
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

/** The hovered cell. */
export function outline(context, frame, { x, y }, [i, j], colours) {
  const [w, h] = [frame.width / x.count, frame.height / y.count];
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.strokeRect(frame.left + i * w - 1, frame.top + (y.count - 1 - j) * h - 1, w + 2, h + 2);
}

/** The frame of cells about their values, on a canvas of this size. */
export function frameOf(width, height, { x, y }) {
  const around = ({ low, high, count }) => {
    const half = (0.5 * (high - low)) / (count - 1);
    return [low - half, high + half];
  };
  return new Frame(inside(width, height, MARGIN), around(x), around(y));
}

/** The cell under a pointer event, if any. */
export function cellOf({ offsetX, offsetY }, frame, { x, y }) {
  const i = Math.floor(((offsetX - frame.left) / frame.width) * x.count);
  const j = Math.floor(((frame.top + frame.height - offsetY) / frame.height) * y.count);
  return i >= 0 && i < x.count && j >= 0 && j < y.count ? [i, j] : null;
}

/** Paints each cell with `fillOf(k)`, if that is defined, and hatches those for which `isUncertain(k)`; x fastest. */
export function paintCells(context, frame, { x, y }, fillOf, isUncertain) {
  const [w, h] = [frame.width / x.count, frame.height / y.count];
  const edge = (k, size) => Math.round(k * size);
  for (let j = 0; j < y.count; j += 1) {
    for (let i = 0; i < x.count; i += 1) {
      const k = j * x.count + i;
      const fill = fillOf(k);
      if (!fill) continue;
      const [left, top] = [edge(i, w), edge(y.count - 1 - j, h)];
      /** @type {[number, number, number, number]} */
      const cell = [frame.left + left, frame.top + top, edge(i + 1, w) - left, edge(y.count - j, h) - top];
      context.fillStyle = fill;
      context.fillRect(...cell);
      if (!isUncertain(k)) continue;
      context.fillStyle = hatch(context);
      context.fillRect(...cell);
    }
  }
}

/**
 * The axes of a map of cells, with their labels.
 * @param {CanvasRenderingContext2D} context
 * @param {Frame} frame
 * @param {any} axes
 * @param {any} colours
 * @param {string[]} words
 */
export function drawCellAxes(context, frame, { x, y }, colours, words) {
  const [across, up] = words;
  const bare = { ...colours, rule: "transparent" };
  drawAxes(context, frame, bare, {
    font: NUMBERS,
    xTicks: ticks(x.low, x.high, frame.width / 70),
    yTicks: ticks(y.low, y.high, frame.height / 40),
  });
  const foot = frame.top + frame.height + MARGIN.bottom - 8;
  label(context, colours, across, frame.left + frame.width / 2, foot, 0, LETTERS);
  label(context, colours, up, 14, frame.top + frame.height / 2, -Math.PI / 2, LETTERS);
}

/** A key at its axis: its symbol with its unit. */
export function axisWords(keys, name) {
  const { symbol, unit } = keys.find((key) => key.name === name);
  return unitText(unit) ? `${withSymbols(symbol)}  [${unitText(unit)}]` : symbol;
}

/**
 * The position of the current run; nothing if one of the coordinates is NaN.
 * @param {CanvasRenderingContext2D} context
 * @param {Frame} frame
 * @param {number[]} at
 */
export function crosshair(context, frame, [vx, vy]) {
  const within = vx >= frame.x0 && vx <= frame.x1 && vy >= frame.y0 && vy <= frame.y1;
  if (!within) return;
  const [x, y] = [frame.x(vx), frame.y(vy)];
  for (const [colour, lineWidth] of [
    ["#fff", 4.5],
    ["#000", 2],
  ]) {
    Object.assign(context, { strokeStyle: colour, lineWidth });
    context.beginPath();
    context.arc(x, y, 6, 0, 2 * Math.PI);
    context.stroke();
  }
}
