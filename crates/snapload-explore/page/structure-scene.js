// A structure to scale, in metres: the water's surface by linear theory, the body, its lines, and their snaps.

import { slackLine } from "./slack-line.js";
import { turned } from "./scene.js";
import { arrow, roundLength } from "./shapes.js";
import { lineColour, mix } from "./theme.js";
import { about, fixed, number, round } from "./formatting.js";

/** How long a snap stays visible during playback, in seconds of real time. */
const AFTERGLOW_S = 0.45;
const PATH_BEHIND_S = 12;
/** Margins below the floor for the numbers of the lines, and at the side for those of the depth [px]. */
const [BELOW_PX, LEFT_PX] = [40, 46];

/** The corners of the body about its centre. */
function outlineOf({ width, height }) {
  const [a, b] = [width / 2, height / 2];
  return [
    [-a, -b],
    [a, -b],
    [a, b],
    [-a, b],
  ];
}

/** The camera, which shows anchors, floor, crests, and the body's motion. z points up the page. */
export function structureCamera(run, { width, height, zoom }) {
  const { geometry, waves, reach } = run;
  const size = Math.hypot(geometry.width, geometry.outline === "circle" ? 0 : geometry.height) / 2;
  const anchors = geometry.lines.map(({ anchor }) => anchor);
  const crest = crestOf(waves);
  const xs = [...anchors.map(([x]) => x), reach.x[0] - size, reach.x[1] + size];
  const [low, high] = [-geometry.depth, Math.max(crest, reach.z[1] + size) + 0.05 * geometry.depth];
  const [left, right] = [Math.min(...xs), Math.max(...xs)];
  const margin = 0.06 * (right - left || 2 * size);
  const usable = [Math.max(width - LEFT_PX, 10), Math.max(height - BELOW_PX, 10)];
  const whole = Math.min(usable[0] / (right - left + 2 * margin), usable[1] / (high - low));
  const scale = zoom ? whole * zoom[0] : whole;
  const middle = zoom ? zoom.slice(1) : [0.5 * (left + right), 0.5 * (low + high)];
  const centre = zoom ? [width / 2, height / 2] : [LEFT_PX + usable[0] / 2, usable[1] / 2];
  const place = ([x, z]) => [centre[0] + scale * (x - middle[0]), centre[1] - scale * (z - middle[1])];
  const unplace = ([x, y]) => [middle[0] + (x - centre[0]) / scale, middle[1] - (y - centre[1]) / scale];
  return { place, unplace, scale, whole, up: -1, level: (z) => place([0, z])[1] };
}

/** The usual height of crests and depth of troughs. */
const crestOf = (waves) => Math.min(waves.reduce((sum, [amplitude]) => sum + amplitude, 0), 2.2 * rms(waves));

/** The standard deviation of the surface times √2: the amplitude of one wave, and about half of Hs/√2 of a sea. */
const rms = (waves) => Math.sqrt(waves.reduce((sum, [amplitude]) => sum + amplitude * amplitude, 0)) || 0.01;

/** All shapes at time t. `options`: width, height [px], zoom, colours, playing, speed, still, and optionally camera. */
export function structureShapes(run, t, options) {
  const cam = options.camera ?? structureCamera(run, options);
  const { colours } = options;
  const moment = run.at(t);
  const snaps = recentSnaps(run, t, options);
  const elastic = run.elasticMoment(t);
  const { lines } = run.geometry;
  return [
    ...water(run, t, cam, options),
    ...depths(run, cam, options),
    ...path(run, t, cam, colours),
    ...lines.flatMap((line, i) => lineShapes(run, i, moment, cam, options, snaps)),
    ...bodyShapes(run, moment, cam, { fill: colours.body, stroke: colours["body-edge"], width: 1.6 }),
    ...lines.map(({ arm }) => ({
      circle: [...cam.place(turned(arm, moment)), 3],
      fill: colours.panel,
      stroke: colours["body-edge"],
      width: 1.4,
    })),
    ...(elastic ? elasticShapes(run, elastic, cam, colours) : []),
    ...snaps.flatMap((snap) => snapShapes(run, snap, moment, cam, options)),
    ...lines.flatMap((line, i) => labelShapes(run, i, moment, cam, options)),
    ...scaleBar(run, cam, options),
  ];
}

/** Impacts that are still visible at t, the latest of each line, with their strength. */
function recentSnaps(run, t, { playing, speed }) {
  const span = playing ? AFTERGLOW_S * speed : 0;
  const seen = new Set();
  return run.snapsWithin(t - span, t).flatMap((i) => {
    const line = run.snaps.line[i];
    if (seen.has(line) || run.snaps.jolt[i]) return [];
    seen.add(line);
    return [{ i, line, left: span > 0 ? 1 - (t - run.snaps.t[i]) / span : 1 }];
  });
}

function water(run, t, cam, { width, height, colours }) {
  const floor = cam.level(-run.geometry.depth);
  const top = [];
  for (let px = 0; px <= width + 5; px += 5) {
    const [x] = cam.unplace([px, 0]);
    top.push([px, cam.level(run.surface(x, t))]);
  }
  const still = cam.level(0);
  const hatch = [];
  for (let x = -10; x < width + 12; x += 12) {
    const points = [
      [x, floor + 9],
      [x + 8, floor + 1],
    ];
    hatch.push({ points, stroke: colours.floor, width: 1 });
  }
  const flat = (y) => [
    [0, y],
    [width, y],
  ];
  const fill = { from: colours["water-high"], to: colours["water-deep"], y0: still, y1: floor };
  return [
    { points: [...top, [width, floor], [0, floor]], closed: true, fill },
    { points: flat(still), stroke: colours.wave, width: 0.8, dash: [2, 4], alpha: 0.8 },
    { points: top, stroke: colours.wave, width: 1.6 },
    { points: [...flat(floor), [width, height + 1], [0, height + 1]], closed: true, fill: colours.paper },
    { points: flat(floor), stroke: colours.floor, width: 1.6 },
    ...hatch,
  ];
}

/** The level at its left edge, in metres. */
function depths(run, cam, { height, colours }) {
  const depth = run.geometry.depth;
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000].find((s) => s * cam.scale >= 26) ?? 5000;
  const shapes = [];
  for (let z = 0; z > -depth + 0.4 * step; z -= step) {
    const y = cam.level(z);
    if (y < 8 || y > height - 8) continue;
    shapes.push(
      { points: [[0, y], [5, y]], stroke: colours.muted, width: 1 },
      { text: `${fixed(z, step < 1 ? 1 : 0)}${z === 0 ? " m" : ""}`, at: [9, y + 4], size: 11, fill: colours.muted, halo: colours["water-high"] },
    );
  }
  return shapes;
}

/** The recent path of the centre. */
function path(run, t, cam, colours) {
  const { t: times, x, z } = run.motion;
  const points = [];
  for (let i = 0; i < times.length && times[i] <= t; i += 1) {
    if (times[i] >= t - PATH_BEHIND_S) points.push(cam.place([x[i], z[i]]));
  }
  return points.length > 1 ? [{ points, stroke: colours.ink, alpha: 0.55, width: 1.1 }] : [];
}

function bodyShapes(run, moment, cam, style) {
  const { geometry } = run;
  const at = cam.place([moment.x, moment.y]);
  const radius = geometry.width / 2;
  const top = geometry.outline === "circle" ? radius : geometry.height / 2;
  const mark = [
    [0, 0.55 * top],
    [0, top],
  ].map((p) => cam.place(turned(p, moment)));
  const shape =
    geometry.outline === "circle"
      ? { circle: [...at, radius * cam.scale] }
      : { points: outlineOf(geometry).map((p) => cam.place(turned(p, moment))), closed: true };
  return [
    { ...shape, ...style },
    { points: mark, stroke: style.stroke, alpha: 0.55 * (style.alpha ?? 1), width: 2 },
    { circle: [...at, 2], fill: style.stroke, alpha: style.alpha },
  ];
}

/** The same on elastic lines. */
function elasticShapes(run, moment, cam, colours) {
  const lines = run.geometry.lines.map((line) => {
    const [from, to] = [cam.place(line.anchor), cam.place(turned(line.arm, moment))];
    const points = slackLine(from, to, line.length * cam.scale, cam.level(-run.geometry.depth));
    return { points, stroke: colours.ghost, width: 1.2, alpha: 0.75, dash: [5, 4] };
  });
  return [...lines, ...bodyShapes(run, moment, cam, { stroke: colours.ghost, width: 1.4, alpha: 0.75 })];
}

/** The utilisation of a line, for its colour; relative to the largest tension of any line if it is not known. */
export function loadFraction(run, i, kilonewtons) {
  const { breaking_load_n } = run.lines[i];
  const most = breaking_load_n ? breaking_load_n / 1e3 : run.mostTension;
  return most > 0 ? Math.min(kilonewtons / most, 1) : 0;
}

function lineShapes(run, i, moment, cam, { colours }, snaps) {
  const line = run.geometry.lines[i];
  const [from, to] = [cam.place(line.anchor), cam.place(turned(line.arm, moment))];
  const foot = [
    [from[0] - 7, from[1] + 8],
    [from[0] + 7, from[1] + 8],
    from,
  ];
  const anchor = { points: foot, closed: true, fill: colours.floor };
  const snap = snaps.find((one) => one.line === i + 1);
  if (moment.taut.includes(i + 1)) {
    const part = loadFraction(run, i, moment.tensions[i]);
    const stroke = mix(colours.taut, colours.strained, Math.sqrt(part));
    return [{ points: [from, to], stroke, width: 2.2 + 5 * part }, anchor];
  }
  const points = slackLine(from, to, line.length * cam.scale, cam.level(-run.geometry.depth));
  const hung = { points, stroke: lineColour(colours, i + 1), width: 1.6 };
  if (!snap) return [hung, anchor];
  const strength = snapPart(run, snap.i) * snap.left;
  const struck = { points: [from, to], stroke: colours.snap, width: 1.5 + 6 * strength, alpha: 0.8 * snap.left ** 4 };
  // At the instant itself the line is straight.
  return snap.left === 1 ? [struck, anchor] : [hung, struck, anchor];
}

/** The size at which a snap is drawn, such that small ones remain visible. */
const snapPart = (run, i) => Math.sqrt(Math.min(run.hardness[i] / (run.hardest || 1), 1));

function snapShapes(run, { i, line, left }, moment, cam, { colours, still, width }) {
  const { arm, anchor } = run.geometry.lines[line - 1];
  const [at, foot] = [cam.place(turned(arm, moment)), cam.place(anchor)];
  const distance = Math.hypot(foot[0] - at[0], foot[1] - at[1]) || 1;
  const part = snapPart(run, i);
  const length = Math.min(0.16 * width, 110) * part;
  const to = at.map((v, k) => v + ((foot[k] - v) / distance) * length);
  const flash = { circle: [...at, 5 + 16 * part * (1.4 - left)], stroke: colours.snap, width: 2, alpha: left };
  const peak = run.snaps.peak[i];
  const words = peak === null ? `${number(run.snaps.speed[i], 2)} m/s` : `${round(peak)} kN`;
  return [
    ...(still ? [] : [flash]),
    ...arrow(at, to, colours.snap, 3, { alpha: still ? 1 : Math.min(1, 1.6 * left) }),
    { text: words, at: [at[0] + 10, at[1] - 8], size: 13, fill: colours.snap, halo: colours["water-deep"], alpha: left },
  ];
}

/** The number of each line and its tension, at its anchor. */
function labelShapes(run, i, moment, cam, { colours, height }) {
  const { anchor } = run.geometry.lines[i];
  const [x, y] = cam.place(anchor);
  if (y > height - 4) return [];
  const taut = moment.taut.includes(i + 1);
  const text = { size: 12, align: "center", fill: lineColour(colours, i + 1) };
  // With many lines there is only room for their numbers.
  const carries = run.geometry.lines.length > 4 ? "" : taut ? `${about(moment)}${round(moment.tensions[i])} kN` : "slack";
  return [
    { ...text, text: `line ${i + 1}`, at: [x, y + 22] },
    { ...text, text: carries, at: [x, y + 36], size: 11, fill: colours.muted },
  ];
}

/** In the water, below the troughs, if there is room; otherwise at the upper edge. */
function scaleBar(run, cam, { width, height, colours }) {
  const nice = roundLength((0.2 * width) / cam.scale);
  const length = nice * cam.scale;
  const trough = cam.level(-crestOf(run.waves)) + 14;
  const floor = Math.min(cam.level(-run.geometry.depth), height);
  const y = trough > 18 && trough < floor - 30 ? trough : 18;
  const x = width - 14 - length;
  const mark = (px) => [
    [px, y - 4],
    [px, y + 4],
  ];
  const style = { stroke: colours.muted, width: 1 };
  return [
    { points: [[x, y], [x + length, y]], ...style },
    { points: mark(x), ...style },
    { points: mark(x + length), ...style },
    { text: `${number(nice)} m`, at: [x + length / 2, y + 16], align: "center", size: 11, fill: colours.muted },
  ];
}

/** A description of the scene for screen readers. */
export function structureWords(run, t) {
  const moment = run.at(t);
  const degrees = fixed((moment.theta * 180) / Math.PI, 1);
  const lines = run.lines.map((_, i) =>
    moment.taut.includes(i + 1) ? `line ${i + 1} taut, ${about(moment)}${round(moment.tensions[i])} kN` : `line ${i + 1} slack`,
  );
  const place = `${about(moment)}x = ${fixed(moment.x, 2)} m, z = ${fixed(moment.y, 2)} m, turned by ${degrees} degrees`;
  return `At t = ${fixed(t, 2)} s the body is at ${place}; ${lines.join("; ")}.`;
}
