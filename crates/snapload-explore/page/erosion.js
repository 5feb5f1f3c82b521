// The erosion of a basin: the safe part of a window along a key, as a line with confidence intervals.

import { Frame, drawAxes, drawColumn, inside, label, prepare, stroke, ticks } from "./plot.js";
import { number } from "./formatting.js";

const MARGIN = { left: 56, right: 12, top: 10, bottom: 36 };

/** Draws an erosion on its canvas, and shows the canvas. */
export function drawErosion(canvas, { points, knee, over }, colours, across) {
  canvas.hidden = false;
  const { context, width, height } = prepare(canvas);
  const there = points.map(({ legal }) => legal > 0);
  const frame = new Frame(inside(width, height, MARGIN), [points[0].value, points.at(-1).value], [0, 1]);
  drawAxes(context, frame, colours, {
    xTicks: ticks(frame.x0, frame.x1, frame.width / 70),
    yTicks: ticks(0, 1, frame.height / 40),
  });
  label(context, colours, across, frame.left + frame.width / 2, height - 6);
  label(context, colours, "safe part", 12, frame.top + frame.height / 2, -Math.PI / 2);
  context.strokeStyle = colours.safe;
  context.lineWidth = 1.2;
  for (const { value, interval95 } of points.filter((_, row) => there[row])) {
    stroke(context, interval95.map((part) => [frame.x(value), frame.y(part)]));
  }
  context.lineWidth = 2;
  const column = (name) => points.map((point) => point[name]);
  // The line has a gap at a value without legal starts, as the safe part there is not known.
  drawColumn(context, frame, column("value"), column("fraction"), 0, points.length, (row) => there[row]);
  if (knee !== null) {
    context.strokeStyle = colours.muted;
    context.lineWidth = 1;
    context.setLineDash([4, 3]);
    stroke(context, [frame.top, frame.top + frame.height].map((y) => [frame.x(knee), y]));
    context.setLineDash([]);
  }
  const part = ({ fraction }, row) => (there[row] ? number(fraction, 3) : "no legal start");
  const text = points.map((point, row) => `${number(point.value, 3)}: ${part(point, row)}`).join(", ");
  canvas.setAttribute("aria-label", `The safe part over ${over}: ${text}`);
}
