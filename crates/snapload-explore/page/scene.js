// The scene as an engineer's sketch: a list of shapes for a run at a time.

import { eventWords } from "./events.js";
import { slackLine } from "./slack-line.js";
import { magnifier } from "./magnifier.js";
import { SimplifiedLine } from "./simplified-line.js";
import { arrow, roundLength } from "./shapes.js";
import { mix } from "./theme.js";
import { about, fixed, modeName, number } from "./formatting.js";

/** How long a snap stays visible during playback, in seconds of real time. */
const AFTERGLOW_S = 0.45;
const PATH_BEHIND = 4;
/** The width of the name of a cable, and the distance of one that is beside its anchor. */
const [NAME_PX, ASIDE_PX] = [46, 10];
const [BEYOND_FLOOR_PX, BEYOND_SURFACE_PX, MOST_BEYOND] = [34, 30, 0.4];

/**
 * The camera: `real` shows the anchors on the sea floor at the bottom, `thesis` is upside down, so that net buoyancy
 * points down the page as a weight. y of the model grows towards the anchors.
 */
export function camera(run, { width, height, picture, view, zoom }) {
  const { a, b } = run.geometry.body;
  const size = Math.hypot(a, b);
  const anchorLevel = run.geometry.cables[0].anchor[1];
  let [left, right] = run.reach.x;
  let [low, high] = run.reach.y;
  const surface = Math.min(low - size, -size) - 0.3;
  // Beyond floor and surface there is room for labels at every scale.
  let [beyondFloor, beyondSurface] = [0, 0];
  if (view === "close") {
    const margin = 1.15 * size + 0.12 * Math.max(right - left, high - low) + 0.01;
    [left, right, low, high] = [left - margin, right + margin, low - margin, high + margin];
  } else {
    [left, right] = [Math.min(left - size, -1) - 0.1, Math.max(right + size, 1) + 0.1];
    [low, high] = [surface, anchorLevel];
    // In a picture too low for the labels the scene keeps most of the height.
    const room = Math.min(1, (MOST_BEYOND * height) / (BEYOND_FLOOR_PX + BEYOND_SURFACE_PX));
    [beyondFloor, beyondSurface] = [room * BEYOND_FLOOR_PX, room * BEYOND_SURFACE_PX];
  }
  const usable = height - beyondFloor - beyondSurface;
  const whole = Math.min(width / (right - left), usable / (high - low));
  const up = picture === "real" ? 1 : -1;
  // Zoomed in by a factor about a point of the plane.
  const scale = zoom ? whole * zoom[0] : whole;
  const middle = zoom ? zoom.slice(1) : [0.5 * (left + right), 0.5 * (low + high)];
  const centre = zoom ? height / 2 : (height + up * (beyondSurface - beyondFloor)) / 2;
  const place = ([px, py]) => [width / 2 + scale * (px - middle[0]), centre + up * scale * (py - middle[1])];
  const unplace = ([x, y]) => [middle[0] + (x - width / 2) / scale, middle[1] + (up * (y - centre)) / scale];
  return { place, unplace, scale, whole, up, surface, anchorLevel, level: (py) => place([0, py])[1] };
}

/**
 * A point of the body's frame in the plane.
 * @param {number[]} point
 * @returns {number[]}
 */
export function turned([x, y], moment) {
  const [c, s] = [Math.cos(moment.theta), Math.sin(moment.theta)];
  return [moment.x + c * x - s * y, moment.y + s * x + c * y];
}

/**
 * All shapes at time t. Of `options`: width, height [px], picture, view, zoom, colours, playing, speed [T/s], still (no
 * flash), and perhaps the camera.
 */
export function sceneShapes(run, t, options) {
  const { colours } = options;
  const cam = options.camera ?? camera(run, options);
  const moment = run.at(t);
  const snaps = recentSnaps(run, t, options);
  const ghost = run.ghostMoment(t);
  const close = options.view === "close";
  const paths = [
    ...path(
      run.motion,
      t,
      cam,
      { stroke: colours.ink, alpha: 0.6, width: close ? 1.4 : 1.1 },
      run.horizon.t,
      colours.past,
    ),
    ...(ghost
      ? path(run.ghost.motion, t, cam, { stroke: colours.ghost, alpha: 0.8, width: close ? 1.4 : 1.1 }, null)
      : []),
  ];
  return [
    ...sea(run, t, cam, options),
    ...(close ? [] : paths),
    ...(ghost ? ghostShapes(run, ghost, cam, options) : []),
    ...run.geometry.cables.flatMap((cable, i) => cableShapes(run, i, moment, cam, options, snaps)),
    ...bodyShapes(run, moment, cam, { fill: colours.body, stroke: colours["body-edge"], width: 1.6 }),
    // Zoomed in, the body is larger than its path and would hide it.
    ...(close ? paths : []),
    ...run.geometry.cables.flatMap((cable) => fairlead(cable, moment, cam, colours)),
    ...snaps.flatMap((snap) => snapShapes(run, snap, moment, cam, options)),
    ...forces(run, t, moment, cam, options),
    ...labels(run, cam, options),
    ...scaleBar(run, cam, options),
    ...magnifier(run, t, cam, options, path),
  ];
}

/**
 * Impacts that are still visible at t, with their strength (1 at the instant itself). A still picture shows only the
 * impacts at its instant.
 */
function recentSnaps(run, t, { playing, speed }) {
  const span = playing ? AFTERGLOW_S * speed : 0;
  const left = (i) => (span > 0 ? 1 - (t - run.impacts.t[i]) / span : 1);
  const all = run.impactsWithin(t - span, t).map((i) => ({ i, left: left(i) }));
  // Of many snaps the latest of each cable is enough.
  return [1, 2].flatMap((cable) => all.filter(({ i }) => run.impacts.cable[i] === cable).slice(0, 1));
}

function sea(run, t, cam, { width, height, picture, colours }) {
  const floor = cam.level(cam.anchorLevel);
  const surface = cam.level(cam.surface);
  const edge = picture === "real" ? [0, height] : [height, 0];
  const water = { fill: { from: "", to: "", y0: surface, y1: floor } };
  water.fill.from = colours["water-high"];
  water.fill.to = colours["water-deep"];
  const top = surfaceLine(run, t, cam, width);
  const hatch = [];
  const beyond = picture === "real" ? 1 : -1;
  for (let x = -10; x < width + 12; x += 12) {
    hatch.push({
      points: [
        [x, floor + beyond * 9],
        [x + 8, floor + beyond * 1],
      ],
      stroke: colours.floor,
      width: 1,
    });
  }
  return [
    { points: [...top, [width, floor], [0, floor]], closed: true, ...water },
    { points: top, stroke: colours.wave, width: 1.4 },
    {
      points: [
        [0, floor],
        [width, floor],
        [width, edge[1]],
        [0, edge[1]],
      ],
      closed: true,
      fill: colours.paper,
    },
    {
      points: [
        [0, floor],
        [width, floor],
      ],
      stroke: colours.floor,
      width: 1.6,
    },
    ...hatch,
  ];
}

/**
 * The surface; its height and length are not to scale, but its phase is that of the forcing: under a wave
 * η = A sin(Ωt − kx) water at x = 0 accelerates as cos Ωt along x and as −sin Ωt upwards, which is +sin Ωt along y.
 */
function surfaceLine(run, t, cam, width) {
  const { nu, omega } = run.values;
  const height = waveHeight(run, cam) * cam.up;
  const level = cam.level(cam.surface);
  const k = Math.sign(nu * omega || 1) * 3.4;
  const points = [];
  for (let px = 0; px <= width + 6; px += 6) {
    const x = (px - cam.place([0, 0])[0]) / cam.scale;
    points.push([px, level - height * Math.sin(omega * t - k * x)]);
  }
  return points;
}

/** The height of a crest above the still water [px]. */
const waveHeight = (run, cam) => 0.045 * cam.scale * Math.tanh(2 * Math.abs(run.values.f_o));

/** The path of the centre up to t: the latest part in full colour, earlier parts paler. */
function path(columns, t, cam, style, horizon, past) {
  const { x, y } = columns;
  const end = columns.t.findIndex((time) => time > t);
  const count = end < 0 ? columns.t.length : end;
  const recent = columns.t.findIndex((time) => time >= t - PATH_BEHIND);
  const lost = horizon === null ? count : columns.t.findIndex((time) => time > horizon);
  const known = lost < 0 ? count : Math.min(lost, count);
  const piece = (from, to, rest) => {
    const points = [];
    const add = (px, py) => points.push([px, py]);
    const line = new SimplifiedLine({ moveTo: add, lineTo: add });
    for (let i = Math.max(from, 0); i < to; i += 1) {
      const [px, py] = cam.place([x[i], y[i]]);
      if (i > from && points.length) line.lineTo(px, py);
      else line.moveTo(px, py);
    }
    line.finish();
    return points.length > 1 ? [{ points, ...style, ...rest }] : [];
  };
  const old = Math.max(recent, 0);
  const pale = 0.4 * style.alpha;
  return [
    ...piece(0, Math.min(old + 1, known), { alpha: pale }),
    ...piece(Math.min(old, known), known, {}),
    ...piece(Math.max(known - 1, 0), Math.max(old + 1, known), { stroke: past, alpha: pale }),
    ...piece(Math.max(known - 1, old), count, { stroke: past }),
  ];
}

function bodyShapes(run, moment, cam, style) {
  const { shape, a, b } = run.geometry.body;
  const at = cam.place([moment.x, moment.y]);
  if (shape === "point") return [{ circle: [...at, 5], ...style }];
  if (shape === "circle") {
    // A diameter through the fairleads and a short stroke towards the anchors show the rotation.
    const across = [
      [-a, 0],
      [a, 0],
    ].map((p) => cam.place(turned(p, moment)));
    const mark = [
      [0, 0.55 * a],
      [0, a],
    ].map((p) => cam.place(turned(p, moment)));
    const inner = { stroke: style.stroke, alpha: 0.55 * (style.alpha ?? 1), width: 1 };
    return [
      { circle: [...at, a * cam.scale], ...style },
      { points: across, ...inner },
      { points: mark, ...inner, width: 2 },
      { circle: [...at, 2], fill: style.stroke, alpha: style.alpha },
    ];
  }
  const corners = [
    [-a, -b],
    [a, -b],
    [a, b],
    [-a, b],
  ].map((p) => cam.place(turned(p, moment)));
  const mark = [
    [0, 0.55 * b],
    [0, b],
  ].map((p) => cam.place(turned(p, moment)));
  return [
    { points: corners, closed: true, ...style },
    { points: mark, stroke: style.stroke, alpha: 0.55 * (style.alpha ?? 1), width: 2 },
    { circle: [...at, 2], fill: style.stroke, alpha: style.alpha },
  ];
}

function ghostShapes(run, ghost, cam, { colours, picture }) {
  const lines = run.geometry.cables.map((cable) => ({
    points: slackPoints(cable, ghost, cam, picture),
    stroke: colours.ghost,
    width: 1.1,
    alpha: 0.6,
    dash: [5, 4],
  }));
  return [...lines, ...bodyShapes(run, ghost, cam, { stroke: colours.ghost, width: 1.4, alpha: 0.7 })];
}

/** A line from its anchor to its fairlead. A slack line hangs downwards, in the real view onto the floor. */
function slackPoints(cable, moment, cam, picture) {
  const from = cam.place(cable.anchor);
  const to = cam.place(turned(cable.arm, moment));
  return slackLine(from, to, cable.length * cam.scale, picture === "real" ? from[1] : Infinity);
}

function cableShapes(run, i, moment, cam, { colours, picture }, snaps) {
  const cable = run.geometry.cables[i];
  const colour = colours[`cable-${i + 1}`];
  const from = cam.place(cable.anchor);
  const anchor = { points: anchorMark(from, cam.up), closed: true, fill: colours.floor };
  const snap = snaps.find((one) => run.impacts.cable[one.i] === i + 1);
  if (moment.taut?.includes(i + 1) ?? moment.tensions[i] > 0) {
    const tension = moment.tensions[i] ?? 0;
    const part = run.mostTension > 0 ? Math.sqrt(Math.max(tension, 0) / run.mostTension) : 0;
    const to = cam.place(turned(cable.arm, moment));
    return [{ points: [from, to], stroke: mix(colours.taut, colours.strained, part), width: 2.2 + 5 * part }, anchor];
  }
  const hung = { points: slackPoints(cable, moment, cam, picture), stroke: colour, width: 1.5 };
  // At the instant itself the line is straight.
  /** @type {object[]} */
  const shapes = snap?.left === 1 ? [anchor] : [hung, anchor];
  if (snap) {
    const strength = impulsePart(run, snap.i) * snap.left;
    const to = cam.place(turned(cable.arm, moment));
    // The line is straight only at the instant: its highlight fades before the arrow does.
    shapes.push({ points: [from, to], stroke: colours.snap, width: 1 + 6 * strength, alpha: 0.8 * snap.left ** 4 });
  }
  return shapes;
}

const anchorMark = ([x, y], up) => [
  [x - 7, y + 8 * up],
  [x + 7, y + 8 * up],
  [x, y],
];

function fairlead(cable, moment, cam, colours) {
  const at = cam.place(turned(cable.arm, moment));
  return [{ circle: [...at, 3], fill: colours.panel, stroke: colours["body-edge"], width: 1.4 }];
}

/** The arrow's length is proportional to the square root of the impulse, so that small ones remain visible. */
const impulsePart = (run, i) => Math.sqrt(run.impacts.impulse[i] / (run.hardest || 1));

/** At the moving fairlead, in the direction of the line at the instant. */
function snapShapes(run, { i, left }, moment, cam, { colours, still, width }) {
  const cable = run.geometry.cables[run.impacts.cable[i] - 1];
  const { before_x, before_y, before_theta } = run.impacts;
  const then = { x: before_x[i], y: before_y[i], theta: before_theta[i] };
  const [from, anchor] = [cam.place(turned(cable.arm, then)), cam.place(cable.anchor)];
  const at = cam.place(turned(cable.arm, moment));
  const distance = Math.hypot(anchor[0] - from[0], anchor[1] - from[1]);
  const length = Math.min(0.16 * width, 110) * impulsePart(run, i);
  const to = at.map((v, k) => v + ((anchor[k] - from[k]) / distance) * length);
  const size = Math.min(1, width / 700);
  const flash = still
    ? []
    : [
        {
          circle: [...at, size * (5 + 16 * impulsePart(run, i) * (1.4 - left))],
          stroke: colours.snap,
          width: 2,
          alpha: left,
        },
        { circle: [...at, size * (7 * impulsePart(run, i) * left + 2)], fill: colours.snap, alpha: 0.8 * left },
      ];
  return [...flash, ...arrow(at, to, colours.snap, 3, { alpha: still ? 1 : Math.min(1, 1.6 * left) })];
}

/** The position of the wave's ellipse next to the body, and the length of the unit of force [px]. */
export function ellipsePlace(run, moment, cam, { width, height }) {
  const { f_o, nu } = run.values;
  const size = Math.min(width, height);
  const most = Math.max(Math.abs(f_o), Math.abs(f_o * nu), 1e-9);
  const clear = 0.9 * Math.abs(cam.level(cam.surface) - cam.level(0));
  const unit = Math.min(0.21 * size, (0.17 * size) / most, Math.max(clear, 0.1 * size));
  const [bx, by] = cam.place([moment.x, moment.y]);
  const { a, b } = run.geometry.body;
  const reach = Math.hypot(a, b) * cam.scale;
  const half = unit * Math.abs(f_o);
  const wide = Math.max(half, 0.04 * size);
  const right = bx + reach + wide + 0.07 * size;
  return { centre: [Math.min(right, width - wide - 14), by], unit };
}

/** The ellipse of the rotating wave force next to the body, and net buoyancy on the same scale. */
function forces(run, t, moment, cam, { width, height, colours }) {
  const { f_o, nu } = run.values;
  const { centre, unit } = ellipsePlace(run, moment, cam, { width, height });
  const [bx, by] = cam.place([moment.x, moment.y]);
  const at = ([fx, fy]) => [centre[0] + unit * fx, centre[1] + cam.up * unit * fy];
  const turn = Array.from({ length: 49 }, (_, k) => (2 * Math.PI * k) / 48);
  const ellipse = turn.map((phase) => at([f_o * Math.cos(phase), nu * f_o * Math.sin(phase)]));
  const force = run.forceAt(t);
  const pull = -cam.up * unit;
  const text = { size: 13, fill: colours.ink, halo: colours["water-deep"], italic: true, align: "center" };
  return [
    { points: ellipse, closed: true, stroke: colours.accent, width: 1, alpha: 0.75 },
    { circle: [...centre, 2], fill: colours.accent },
    ...arrow(centre, at(force), colours.accent, 2),
    ...arrow([bx, by], [bx, by + pull], colours.muted, 1.6),
    { ...text, text: "F", at: [bx + 12, by + pull + (pull < 0 ? 8 : 0)], fill: colours.muted },
    { ...text, text: "f", at: [at(force)[0] + 9 * Math.sign(force[0] || 1), at(force)[1] - 4], fill: colours.accent },
  ];
}

function labels(run, cam, { width, height, colours, view }) {
  const text = { size: 11, fill: colours.muted };
  const below = cam.up > 0 ? 1 : -1;
  const floor = cam.level(cam.anchorLevel);
  const surface = cam.level(cam.surface);
  const inside = (y) => y > 4 && y < height - 4;
  const anchors = run.geometry.cables.map((cable) => cam.place(cable.anchor)[0]);
  const left = Math.min(...anchors);
  const close = Math.max(...anchors) - left < NAME_PX;
  const shapes = [];
  if (view !== "close") {
    const names = run.geometry.cables.map((cable, i) => {
      const [x, y] = cam.place(cable.anchor);
      const dy = below > 0 ? 24 : -16;
      // The names of anchors that are close together are on either side.
      const isLeft = i === anchors.indexOf(left);
      const align = close ? (isLeft ? "right" : "left") : "center";
      const aside = close ? (isLeft ? -ASIDE_PX : ASIDE_PX) : 0;
      return { ...text, text: `cable ${i + 1}`, at: [x + aside, y + dy], align, fill: colours[`cable-${i + 1}`] };
    });
    shapes.push(...names);
  }
  if (inside(floor)) {
    const free = view === "close" || anchors.every((x) => Math.abs(x - width / 2) > NAME_PX + 2 * ASIDE_PX);
    const place = free ? { at: [width / 2], align: "center" } : { at: [12] };
    shapes.push({ ...text, text: "sea floor", ...place, at: [...place.at, floor + (below > 0 ? 24 : -16)] });
  }
  if (inside(surface)) {
    const clear = waveHeight(run, cam) + (below > 0 ? 17 : 7);
    shapes.push({ ...text, text: "sea surface (schematic)", at: [12, surface + below * Math.max(clear, below > 0 ? 30 : 22)] });
  }
  return shapes;
}

function scaleBar(run, cam, { width, height, colours }) {
  const nice = roundLength((0.22 * width) / cam.scale);
  const length = nice * cam.scale;
  // Just below the surface and its troughs, with its number above it, if the surface is visible; otherwise at the edge.
  const clear = waveHeight(run, cam) + (cam.up > 0 ? 24 : 8);
  const surface = cam.level(cam.surface) + Math.max(clear, 26) * cam.up;
  const y = surface > 20 && surface < height - 8 ? surface : 24;
  const x = width - 14 - length;
  const ends = [x, x + length].map((px) => ({
    points: [
      [px, y - 4],
      [px, y + 4],
    ],
    stroke: colours.muted,
    width: 1,
  }));
  return [
    {
      points: [
        [x, y],
        [x + length, y],
      ],
      stroke: colours.muted,
      width: 1,
    },
    ...ends,
    { text: `${number(nice)} L`, at: [x + length / 2, y - 7], align: "center", size: 11, fill: colours.muted },
  ];
}

/** A description of the scene for screen readers. */
export function sceneWords(run, t) {
  const moment = run.at(t);
  const [x, y, theta] = [moment.x, moment.y, moment.theta].map((value) => fixed(value, 3));
  const tension = (cable) => about(moment) + number(moment.tensions[cable - 1], 3);
  const taut = moment.taut?.map((cable) => `cable ${cable} taut, tension ${tension(cable)} F`);
  const lines = !taut ? "" : taut.length ? `: ${taut.join("; ")}` : ": both cables slack";
  const happens = eventWords(run, t);
  return (
    `At t = ${fixed(t, 3)} T the body is at ${about(moment)}x = ${x}, y = ${y}, θ = ${theta}; ${modeName(moment.taut)}${lines}` +
    `${happens ? `; at this instant: ${happens}` : ""}.`
  );
}
