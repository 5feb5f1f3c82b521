// θ, v_n, tensions and energy against time.

import { drawColumn, drawMarks, label, span } from "./plot.js";
import { TimeCharts, above, rows } from "./time-charts.js";
import { about, fixed, number } from "./formatting.js";

function latestSnap(run, t) {
  if (!run.listed(t)) return "latest not known";
  const i = run.latestImpact(t);
  return i < 0 ? "none yet" : `${number(run.impacts.v_n[i], 4)} L/T, latest`;
}

/** A description of an impact in a line. */
export function impactWords(run, i) {
  const { cable, v_n, impulse, digits, t } = run.impacts;
  const known = Number.isFinite(digits[i]) ? ` · ${Math.max(0, Math.floor(digits[i]))} digits` : "";
  const when = `impact ${i + 1}, cable ${cable[i]} · t ${number(t[i], 6)}`;
  return `${when} · vₙ ${number(v_n[i])} · impulse ${number(impulse[i])}${known}`;
}

/** A run and the pinned ones. */
const all = (run, pins) => [run, ...pins.map((pin) => pin.run)];

/** The range of a column as text. */
const reach = (column) =>
  span([column], 0)
    .map((v) => number(v, 3))
    .join(" to ");

/** A column of the motion as a line, with those of pinned runs beneath it, and that of the ghost. */
function line(name) {
  const within = (motion, frame) => rows(motion.t, [frame.x0, frame.x1]);
  return (context, frame, run, { colours, pins }) => {
    const draw = (motion) => drawColumn(context, frame, motion.t, motion[name], ...within(motion, frame));
    for (const pin of pins) {
      context.strokeStyle = pin.colour;
      draw(pin.run.motion);
    }
    context.strokeStyle = colours.ink;
    draw(run.motion);
    if (!run.ghost) return;
    context.strokeStyle = colours.ghost;
    context.setLineDash([5, 3]);
    draw(run.ghost.motion);
    context.setLineDash([]);
  };
}

function drawSnaps(context, frame, run, { colours, pins }) {
  const marks = ({ impacts }, colourOf, size) => {
    const shown = impacts.t.flatMap((t, i) => {
      const there = t >= frame.x0 && t <= frame.x1 && impacts.v_n[i] > 0;
      return there ? [{ cable: impacts.cable[i], x: frame.x(t), y: frame.y(impacts.v_n[i]) }] : [];
    });
    drawMarks(context, shown, colourOf, size);
  };
  for (const pin of pins) marks(pin.run, () => pin.colour, 2.2);
  marks(run, (cable) => colours[`cable-${cable}`], 2.8);
}

/** The tension of a cable while it is taut; there is no line while it is slack. */
function drawTensions(context, frame, run, { colours }) {
  if (!(run.timeTaut > 0)) {
    const [x, y] = [frame.left + frame.width / 2, frame.top + frame.height / 2];
    label(context, colours, "no interval with a taut cable", x, y);
  }
  const { t } = run.motion;
  const [from, to] = rows(t, [frame.x0, frame.x1]);
  context.lineWidth = 1.8;
  for (const cable of [1, 2]) {
    const T = run.motion[`T${cable}`];
    context.strokeStyle = colours[`cable-${cable}`];
    drawColumn(context, frame, t, T, from, to, (i) => T[i] > 0);
  }
}

const CHARTS = [
  {
    id: "theta",
    symbol: "θ",
    unit: "rad",
    name: "Rotation",
    range: (run, seen, pins) => span(all(run, pins).map(({ motion }) => seen(motion, motion.theta))),
    draw: line("theta"),
    value: (moment) => moment.theta,
    read: (run, moment) => `${about(moment)}${fixed(moment.theta, 4)} rad`,
    words: (run) => `from ${reach(run.motion.theta)} rad`,
  },
  {
    id: "snaps",
    symbol: "vₙ",
    unit: "L/T",
    name: "Snap velocity",
    range: (run, seen, pins) => above(span(all(run, pins).map(({ impacts }) => seen(impacts, impacts.v_n)))),
    draw: drawSnaps,
    read: (run, moment) => latestSnap(run, moment.t),
    marks: ({ impacts }) => ({ t: impacts.t, y: impacts.v_n }),
    markWords: impactWords,
    words: (run) => `${run.snaps} impacts, the hardest ${number(run.norms.rho1)} L/T`,
  },
  {
    id: "tensions",
    symbol: "T",
    unit: "F",
    name: "Tensions",
    range: (run, seen, pins) =>
      above(span(all(run, pins).flatMap(({ motion }) => [seen(motion, motion.T1), seen(motion, motion.T2)]))),
    draw: drawTensions,
    read: (run, moment) => about(moment) + moment.tensions.map((T, i) => `T${"₁₂"[i]} ${number(T, 3)}`).join("  ") + " F",
    words: (run) => (run.timeTaut > 0 ? `up to about ${number(run.mostTension, 2)} F` : "no interval with a taut cable"),
  },
  {
    id: "energy",
    symbol: "E",
    unit: "F L",
    name: "Energy",
    range: (run, seen, pins) => span(all(run, pins).map(({ motion }) => seen(motion, motion.energy))),
    draw: line("energy"),
    value: (moment) => moment.energy,
    read: (run, moment) => `${about(moment)}${fixed(moment.energy, 5)} F L`,
    words: (run) => `from ${reach(run.motion.energy)} F L`,
  },
];

export class Charts extends TimeCharts {
  constructor(root, options) {
    super(root, CHARTS, { ...options, unit: "T" });
  }
}
