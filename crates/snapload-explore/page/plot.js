// Axes on a canvas, for the charts, the trajectory and the map.

import { SimplifiedLine } from "./simplified-line.js";
import { fixed, number } from "./formatting.js";
import { isPrinting } from "./theme.js";

/** Round values across a range: about a given number, at least two. */
export function ticks(low, high, about) {
  const rough = (high - low) / Math.max(about, 1);
  if (!(rough > 0) || !Number.isFinite(rough)) return { values: [low], label: (v) => number(v) };
  const power = 10 ** Math.floor(Math.log10(rough));
  const steps = [10, 5, 2, 1, 0.5, 0.2].map((m) => m * power);
  const coarse = steps.findLast((s) => s >= rough * 0.999);
  const multiples = (s) => [Math.ceil(low / s - 1e-9), Math.floor(high / s + 1e-9)];
  const step = steps.find((s) => s <= coarse && multiples(s)[1] > multiples(s)[0]) ?? coarse;
  const [first, last] = multiples(step);
  const values = [];
  for (let k = first; k <= last; k += 1) values.push(k * step);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const label = (v) => (decimals > 6 ? number(v, 3) : fixed(Math.abs(v) < step * 1e-6 ? 0 : v, decimals));
  return { values, label };
}

/** The frame of a canvas within its margins: at least a pixel, as a hidden canvas has no size. */
export const inside = (width, height, { left, right, top, bottom }) => [
  left,
  top,
  Math.max(width - left - right, 1),
  Math.max(height - top - bottom, 1),
];

/** A rectangle of the page that shows a range of x and a range of y. */
export class Frame {
  /**
   * @param {number[]} rectangle left, top, width and height [px]
   * @param {number[]} across the range of x
   * @param {number[]} up the range of y
   */
  constructor([left, top, width, height], [x0, x1], [y0, y1]) {
    this.left = left;
    this.top = top;
    this.width = width;
    this.height = height;
    this.x0 = x0;
    this.x1 = x1;
    this.y0 = y0;
    this.y1 = y1;
  }

  x(value) {
    return this.left + ((value - this.x0) / (this.x1 - this.x0)) * this.width;
  }

  y(value) {
    return this.top + this.height - ((value - this.y0) / (this.y1 - this.y0)) * this.height;
  }

  atX(px) {
    return this.x0 + ((px - this.left) / this.width) * (this.x1 - this.x0);
  }

  holdsX(value) {
    return value >= this.x0 && value <= this.x1;
  }

  clip(context) {
    context.beginPath();
    context.rect(this.left, this.top, this.width, this.height);
    context.clip();
  }
}

export const fontOf = (px) => `${px}px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif`;
export const FONT = fontOf(11);

/** Grid lines and their numbers; those of x only on request. */
export function drawAxes(context, frame, colours, { xLabels = true, xTicks, yTicks, font = FONT }) {
  context.save();
  context.font = font;
  context.lineWidth = 1;
  context.fillStyle = colours.muted;
  context.strokeStyle = colours.rule;
  context.textBaseline = "middle";
  context.textAlign = "right";
  for (const value of yTicks.values) {
    const y = crisp(frame.y(value));
    stroke(context, [
      [frame.left, y],
      [frame.left + frame.width, y],
    ]);
    context.fillText(yTicks.label(value), frame.left - 6, y);
  }
  context.textBaseline = "top";
  context.textAlign = "center";
  for (const value of xTicks.values) {
    const x = crisp(frame.x(value));
    stroke(context, [
      [x, frame.top],
      [x, frame.top + frame.height],
    ]);
    if (!xLabels) continue;
    const text = xTicks.label(value);
    // A label at the edge of the canvas is moved inwards.
    const half = context.measureText(text).width / 2;
    const room = context.canvas.width / context.getTransform().a;
    context.fillText(text, Math.min(Math.max(x, half), room - half), frame.top + frame.height + 6);
  }
  context.strokeStyle = colours.faint;
  context.strokeRect(crisp(frame.left), crisp(frame.top), Math.round(frame.width), Math.round(frame.height));
  context.restore();
}

const crisp = (px) => Math.round(px) + 0.5;

export function stroke(context, points) {
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

/** A text centred at a position, optionally turned. */
export function label(context, colours, text, x, y, angle = 0, font = FONT) {
  context.save();
  context.translate(x, y);
  context.rotate(angle);
  context.font = font;
  context.fillStyle = colours.muted;
  context.textAlign = "center";
  context.fillText(text, 0, 0);
  context.restore();
}

/** Of marks closer together than this [px] only one is drawn, as the others would not be visible. */
export const NEAR_PX = 0.4;

/**
 * One column against another as a line, with gaps at rows that are not `there`.
 * @param {CanvasRenderingContext2D} context
 * @param {Frame} frame
 * @param {number[]} xs
 * @param {number[]} ys
 * @param {number} from
 * @param {number} to
 * @param {(row: number) => boolean} there
 */
export function drawColumn(context, frame, xs, ys, from = 0, to = xs.length, there = () => true) {
  const line = new SimplifiedLine(context);
  let drawing = false;
  context.beginPath();
  for (let i = from; i < to; i += 1) {
    const drawn = there(i);
    if (drawn && drawing) line.lineTo(frame.x(xs[i]), frame.y(ys[i]));
    else if (drawn) line.moveTo(frame.x(xs[i]), frame.y(ys[i]));
    drawing = drawn;
  }
  line.finish();
  context.stroke();
}

/** Marks of snaps: strokes between corners, in halves of their size; a ring for cable 2. */
const MARKS = [
  [[[-1, -1], [1, 1]], [[-1, 1], [1, -1]]],
  null,
  [[[0, -1.2], [1.1, 0.9], [-1.1, 0.9], [0, -1.2]]],
  [[[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]],
  [[[-1.3, 0], [1.3, 0]], [[0, -1.3], [0, 1.3]]],
  [[[0, -1.4], [1.4, 0], [0, 1.4], [-1.4, 0], [0, -1.4]]],
];

/**
 * The marks of snaps, each { cable, x, y }: a cross for cable 1, a ring for cable 2, other shapes for more. Those of a
 * colour are painted together, which is faster; of the thousands of an accumulation, all in one place, one is drawn.
 */
export function drawMarks(context, marks, colourOf, size) {
  for (const cable of new Set(marks.map((mark) => mark.cable))) {
    const places = new Set();
    context.strokeStyle = colourOf(cable);
    context.beginPath();
    for (const { x, y } of marks.filter((mark) => mark.cable === cable)) {
      const place = `${Math.round(x / NEAR_PX)} ${Math.round(y / NEAR_PX)}`;
      if (!places.has(place)) addMark(context, cable, x, y, size);
      places.add(place);
    }
    context.stroke();
  }
}

function addMark(context, cable, x, y, size) {
  const strokes = MARKS[(cable - 1) % MARKS.length];
  if (!strokes) {
    context.moveTo(x + size * 1.1, y);
    context.arc(x, y, size * 1.1, 0, 2 * Math.PI);
  }
  for (const points of strokes ?? []) {
    points.forEach(([dx, dy], i) => {
      if (i) context.lineTo(x + dx * size, y + dy * size);
      else context.moveTo(x + dx * size, y + dy * size);
    });
  }
}

/** The range of a column with a margin; never empty. */
export function span(columns, air = 0.06) {
  let [low, high] = [Infinity, -Infinity];
  for (const column of columns) {
    for (const value of column) {
      if (value === null) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return [0, 1];
  const pad = air * (high - low) || Math.max(0.05, 0.1 * Math.abs(high));
  return [low - pad, high + pad];
}

const sizes = new Map();
const resized = new Set();
const watcher = new ResizeObserver((entries) => {
  for (const { target } of entries) sizes.set(target, [target.clientWidth, target.clientHeight]);
  for (const listener of resized) listener();
});

/** Calls back when a canvas has changed its size. */
export const onResize = (listener) => resized.add(listener);

/** A picture that is painted once a frame, however often it is requested. */
export class FramedPicture {
  constructor(paint) {
    this.paint = paint;
    this.framed = null;
  }

  request() {
    // Before the page is printed there is no other frame.
    if (isPrinting()) this.paintNow();
    else this.framed ??= requestAnimationFrame(() => this.paintNow());
  }

  paintNow() {
    cancelAnimationFrame(this.framed);
    this.framed = null;
    this.paint();
  }
}

/** A canvas at the resolution of the screen, cleared, with its context in CSS pixels. */
export function prepare(canvas) {
  if (!sizes.has(canvas)) {
    // Reading the size each time would force a layout before every picture.
    sizes.set(canvas, [canvas.clientWidth, canvas.clientHeight]);
    watcher.observe(canvas);
  }
  const [width, height] = sizes.get(canvas);
  const ratio = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}
