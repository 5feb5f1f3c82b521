// The motion of a structure against time: surface, position, rotation, and tensions with the breaking loads.

import { drawColumn, drawMarks, span } from "./plot.js";
import { TimeCharts, above, rows } from "./time-charts.js";
import { lineColour } from "./theme.js";
import { about, fixed, number, ratio, round } from "./formatting.js";

const DEGREES = 180 / Math.PI;
/** The breaking load is drawn if tensions reach this part of it. */
const IN_SIGHT = 0.3;

const reach = (column, scale = 1) => span([column], 0).map((v) => fixed(v * scale, 2)).join(" to ");

/** A column as a line, and that of the run on elastic lines. */
function line(name, scale = 1) {
  const scaled = (column) => (scale === 1 ? column : column.map((v) => v * scale));
  return (context, frame, run, { colours }) => {
    const draw = (motion, interval) =>
      drawColumn(context, frame, motion.t, scaled(motion[name]), ...rows(motion.t, interval));
    if (run.elasticAt) {
      context.strokeStyle = colours.ghost;
      dashed(context, frame, run, draw);
    }
    context.strokeStyle = colours.ink;
    draw(run.motion, [frame.x0, frame.x1]);
  };
}

/** Draws the motion on elastic lines with dashes, and with dots past its own horizon of trust. */
function dashed(context, frame, run, draw) {
  const horizon = Math.min(Math.max(run.elasticHorizon, frame.x0), frame.x1);
  const parts = [
    { interval: [frame.x0, horizon], dash: [5, 3] },
    { interval: [horizon, frame.x1], dash: [1.5, 4] },
  ];
  for (const { interval, dash } of parts.filter(({ interval: [from, to] }) => to > from)) {
    context.setLineDash(dash);
    draw(run.elastic.motion, interval);
  }
  context.setLineDash([]);
}

/**
 * A range of at least a visible size, so that rounding is not drawn as motion.
 * @param {number} least
 * @param {number[]} range
 */
function atLeast(least, [low, high]) {
  const more = Math.max(least - (high - low), 0) / 2;
  return [low - more, high + more];
}

const both = (run, name) => [run.motion[name], ...(run.elasticAt ? [run.elastic.motion[name]] : [])];

function drawSurface(context, frame, run, { colours }) {
  const [x] = run.geometry.rest;
  const t = Array.from({ length: 400 }, (_, k) => frame.x0 + ((frame.x1 - frame.x0) * k) / 399);
  context.strokeStyle = colours.wave;
  context.lineWidth = 1.5;
  drawColumn(context, frame, t, t.map((time) => run.surface(x, time)));
}

/** The breaking loads of the lines [kN], each once. */
export const breakingLoads = (run) => [
  ...new Set(run.lines.flatMap(({ breaking_load_n }) => (breaking_load_n ? [breaking_load_n / 1e3] : []))),
];

/** The peaks of the snaps within the interval that is shown. */
const peaksWithin = (run, [from, to]) => {
  const { t, peak } = run.snaps;
  return peak.filter((value, i) => value !== null && t[i] >= from && t[i] <= to);
};

function tensionRange(run) {
  const columns = [run.motion, ...(run.elasticAt ? [run.elastic.motion] : [])].flatMap(({ tensions }) => tensions);
  const [, high] = above(span([...columns, peaksWithin(run, run.window)]));
  const loads = breakingLoads(run).filter((load) => high >= IN_SIGHT * load);
  return [0, Math.max(high, ...loads.map((load) => 1.06 * load))];
}

/** Tensions while taut, the peaks of snaps as marks, and the breaking loads. */
function drawTensions(context, frame, run, { colours }) {
  for (const load of breakingLoads(run)) {
    context.strokeStyle = colours.bad;
    context.lineWidth = 1.2;
    context.setLineDash([7, 4]);
    drawColumn(context, frame, [frame.x0, frame.x1], [load, load]);
    context.setLineDash([]);
  }
  const draw = ({ t, tensions }, i, interval) => {
    drawColumn(context, frame, t, tensions[i], ...rows(t, interval), (k) => tensions[i][k] > 0);
  };
  run.lines.forEach((_, i) => {
    context.strokeStyle = lineColour(colours, i + 1);
    if (run.elasticAt) {
      context.lineWidth = 1;
      dashed(context, frame, run, (motion, interval) => draw(motion, i, interval));
    }
    context.lineWidth = 1.8;
    draw(run.motion, i, [frame.x0, frame.x1]);
  });
  const { t, peak, line: lines } = run.snaps;
  context.lineWidth = 1.3;
  const shown = t.flatMap((time, i) => {
    const there = time >= frame.x0 && time <= frame.x1 && peak[i] !== null;
    return there ? [{ cable: lines[i], x: frame.x(time), y: frame.y(peak[i]) }] : [];
  });
  drawMarks(context, shown, (line) => lineColour(colours, line), 2.8);
}

/** A description of a snap in a line. */
export function snapWords(run, i) {
  const { t, line: lines, speed, peak, utilisation, jolt } = run.snaps;
  const what = jolt[i] ? "impact while taut of" : "snap of";
  const pulls = peak[i] === null ? "" : ` · about ${round(peak[i])} kN`;
  const part = utilisation[i] === null ? "" : `, ${ratio(utilisation[i])} of the breaking load`;
  return `${what} line ${lines[i]}${pulls}${part} · ${number(speed[i], 3)} m/s · t ${fixed(t[i], 2)} s`;
}

const CHARTS = [
  {
    id: "surface",
    symbol: "η",
    unit: "m",
    name: "Water surface above the place of rest",
    range: (run) => {
      const most = run.waves.reduce((sum, [amplitude]) => sum + amplitude, 0);
      const likely = 2.6 * Math.sqrt(run.waves.reduce((sum, [a]) => sum + a * a, 0));
      return [-Math.min(most * 1.1, likely) || -1, Math.min(most * 1.1, likely) || 1];
    },
    draw: drawSurface,
    value: (moment) => moment.surface,
    read: (run, moment) => `${fixed(moment.surface, 2)} m`,
    words: (run) => (run.waves.length === 1 ? "a regular wave" : `a sum of ${run.waves.length} waves`),
  },
  {
    id: "x",
    symbol: "x",
    unit: "m",
    name: "Surge",
    range: (run) => atLeast(0.01, span(both(run, "x"))),
    draw: line("x"),
    value: (moment) => moment.x,
    read: (run, moment) => `${about(moment)}${fixed(moment.x, 3)} m`,
    words: (run) => `from ${reach(run.motion.x)} m`,
  },
  {
    id: "z",
    symbol: "z",
    unit: "m",
    name: "Heave",
    range: (run) => atLeast(0.01, span(both(run, "z"))),
    draw: line("z"),
    value: (moment) => moment.y,
    read: (run, moment) => `${about(moment)}${fixed(moment.y, 3)} m`,
    words: (run) => `from ${reach(run.motion.z)} m`,
  },
  {
    id: "theta",
    symbol: "θ",
    unit: "°",
    name: "Rotation",
    range: (run) => atLeast(0.1, span(both(run, "theta")).map((v) => v * DEGREES)),
    draw: line("theta", DEGREES),
    value: (moment) => moment.theta * DEGREES,
    read: (run, moment) => `${about(moment)}${fixed(moment.theta * DEGREES, 2)}°`,
    words: (run) => `from ${reach(run.motion.theta, DEGREES)} degrees`,
  },
  {
    id: "tensions",
    symbol: "T",
    unit: "kN",
    name: "Tensions, and peaks of snaps",
    range: tensionRange,
    draw: drawTensions,
    read: (run, moment) =>
      about(moment) +
      (run.lines.length > 3
        ? `at most ${round(Math.max(...moment.tensions))} kN`
        : moment.tensions.map((T, i) => `${i + 1}: ${round(T)}`).join("  ") + " kN"),
    marks: ({ snaps }) => ({ t: snaps.t, y: snaps.peak }),
    markWords: snapWords,
    words: (run) => `at most ${round(run.mostTension)} kN while taut; ${run.snapsInWords}`,
  },
];

export class StructureCharts extends TimeCharts {
  constructor(root, options) {
    super(root, CHARTS, { ...options, unit: "s" });
  }
}
