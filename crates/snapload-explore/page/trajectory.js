// The path of the body's centre, with the boundaries at which a cable is taut; or another plane of the motion.

import { FONT, Frame, drawAxes, drawColumn, drawMarks, inside, label, prepare, span, stroke, ticks } from "./plot.js";
import { about, fixed, number } from "./formatting.js";

const MARGIN = { left: 50, right: 10, top: 8, bottom: 34 };
const REACH_PX = 40;
const MOST_MARKS = 2500;
const MOST_POINTS = 20_000;
const PIECES = 64;
/** The number of rotations at which a boundary is tested for being in the frame. */
const LOOKS = 60;

/** The planes of the motion: their columns with the labels of their axes. */
export const PLANES = {
  path: { words: "Path of the centre", x: "x", y: "y", axes: ["x  [L]", "y  [L], towards the anchors"] },
  x: { words: "Phase plane of x", x: "x", y: "vx", axes: ["x  [L]", "velocity along x  [L/T]"] },
  y: { words: "Phase plane of y", x: "y", y: "vy", axes: ["y  [L]", "velocity along y  [L/T]"] },
  theta: { words: "Phase plane of θ", x: "theta", y: "vtheta", axes: ["θ  [rad]", "angular velocity  [rad/T]"] },
  section: {
    words: "Section once per period, x and y",
    x: "x",
    y: "y",
    axes: ["x  [L] at t = k 2π/|Ω|", "y  [L]"],
    section: true,
  },
};

export class Trajectory {
  constructor(figure, { colours, onJump, onHover }) {
    const over = figure.querySelector("svg");
    this.base = figure.querySelector("canvas");
    this.over = over;
    this.colours = colours;
    this.run = null;
    this.frame = null;
    this.boundaries = over.querySelectorAll(".boundary");
    this.now = over.querySelector(".at.now");
    this.hovered = over.querySelector(".at.hovered");
    this.window = over.querySelector("svg");
    this.reading = figure.querySelector("output");
    this.legend = figure.parentElement.querySelectorAll(".legend [data-of]");
    over.addEventListener("pointermove", (event) => {
      if (event.buttons === 0 || event.pointerType === "mouse") onHover(this.#timeNear(event));
    });
    over.addEventListener("pointerleave", () => onHover(null));
    over.addEventListener("click", (event) => {
      const t = this.#timeNear(event);
      if (t !== null) onJump(t);
    });
  }

  /** The time at which the path is nearest to the pointer, if it is near enough. */
  #timeNear(event) {
    if (!this.run) return null;
    const { t } = this.run.motion;
    const [x, y] = this.#columns(this.run.motion);
    const box = this.over.getBoundingClientRect();
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    let best = [REACH_PX, null];
    for (let i = this.rows[0]; i < this.rows[1]; i += 1) {
      const distance = Math.hypot(this.frame.x(x[i]) - px, this.frame.y(y[i]) - py);
      if (distance < best[0]) best = [distance, t[i]];
    }
    return best[1];
  }

  /**
   * The columns of a motion that are drawn against each other.
   * @returns {[number[], number[]]}
   */
  #columns(motion) {
    return [motion[this.plane.x], motion[this.plane.y]];
  }

  get #isPath() {
    return this.plane === PLANES.path;
  }

  draw(run, { window, picture, plane }, pins) {
    this.run = run;
    this.pins = pins;
    this.plane = PLANES[plane];
    this.rows = rowsWithin(run.motion.t, window ?? [0, run.tEnd]);
    const colours = this.colours();
    const { context, width, height } = prepare(this.base);
    this.frame = this.#frameFor(width, height, picture);
    const { frame } = this;
    drawAxes(context, frame, colours, {
      xTicks: ticks(frame.x0, frame.x1, frame.width / 75),
      yTicks: ticks(Math.min(frame.y0, frame.y1), Math.max(frame.y0, frame.y1), frame.height / 34),
    });
    const [across, up] = this.plane.axes;
    label(context, colours, across, frame.left + frame.width / 2, height - 5);
    label(context, colours, up, 11, frame.top + frame.height / 2, -Math.PI / 2);
    context.save();
    frame.clip(context);
    this.#pinned(context);
    if (this.plane.section) this.#section(context, colours);
    else {
      if (this.#isPath) this.#upright(context, colours);
      this.#legs(context, colours);
      if (this.#isPath) this.#marks(context, colours);
      this.#ghost(context, colours);
    }
    context.restore();
    if (!this.plane.section) this.#letters(context, colours);
    this.#legend();
    const reach = `${this.plane.axes[0]} from ${number(frame.x0, 3)} to ${number(frame.x1, 3)}`;
    this.base.setAttribute("aria-label", `${this.plane.words}: ${reach}; y at most ${number(run.norms.y_max, 3)} L.`);
  }

  /** Pinned runs, within the time that is shown. */
  #pinned(context) {
    const { t } = this.run.motion;
    const shown = [t[this.rows[0]], t[this.rows[1] - 1]];
    context.lineWidth = 1.2;
    for (const { run, colour } of this.plane.section ? [] : this.pins) {
      context.strokeStyle = colour;
      drawColumn(context, this.frame, ...this.#columns(run.motion), ...rowsWithin(run.motion.t, shown));
    }
  }

  /** The section once a period of the forcing, at its phase at t = 0; points past the horizon are pale. */
  #section(context, colours) {
    const { run } = this;
    const { t } = run.motion;
    for (const at of sectionTimes(run.values.omega, [t[this.rows[0]], t[this.rows[1] - 1]])) {
      const moment = run.at(at);
      context.fillStyle = run.beyond(moment.t) ? colours.past : colours.ink;
      context.beginPath();
      context.arc(this.frame.x(moment.x), this.frame.y(moment.y), 2.4, 0, 2 * Math.PI);
      context.fill();
    }
  }

  /** One scale for both axes, as in the scene; y grows downwards on the page where the anchors are below. */
  #frameFor(width, height, picture) {
    const [from, to] = this.rows;
    const of = (column) => span([column.slice(from, to)]);
    const [left, top, w, h] = inside(width, height, MARGIN);
    const [x, y] = this.#columns(this.run.motion).map(of);
    if (this.plane.x !== "x" || this.plane.y !== "y") return new Frame([left, top, w, h], x, y);
    const scale = Math.max((x[1] - x[0]) / w, (y[1] - y[0]) / h, 1e-12);
    /** @param {number[]} range @param {number} size */
    const around = ([low, high], size) => [0.5 * (low + high - size * scale), 0.5 * (low + high + size * scale)];
    const [ys, xs] = [around(y, h), around(x, w)];
    this.perPx = scale;
    return new Frame([left, top, w, h], xs, picture === "real" ? ys.reverse() : ys);
  }

  /**
   * The positions of the centre with a just taut cable at this rotation: a circle about the anchor minus the arm.
   * Only the part in the frame, as the circle of a long cable is too large to be drawn.
   */
  #boundary({ anchor, arm, length }, theta) {
    const { frame } = this;
    const [c, s] = [Math.cos(theta), Math.sin(theta)];
    const [x, y] = [frame.x(anchor[0] - (c * arm[0] - s * arm[1])), frame.y(anchor[1] - (s * arm[0] + c * arm[1]))];
    const radius = length / this.perPx;
    const towards = Math.atan2(frame.top + frame.height / 2 - y, frame.left + frame.width / 2 - x);
    const half = Math.min(Math.hypot(frame.width, frame.height) / radius, Math.PI);
    return Array.from({ length: PIECES + 1 }, (_, k) => {
      const angle = towards + half * ((2 * k) / PIECES - 1);
      return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
    });
  }

  /** The boundaries of an upright body. */
  #upright(context, colours) {
    context.strokeStyle = colours.muted;
    context.lineWidth = 1.1;
    context.setLineDash([2, 3]);
    for (const cable of this.run.geometry.cables) stroke(context, this.#boundary(cable, 0));
    context.setLineDash([]);
  }

  #legs(context, colours) {
    const { run } = this;
    const { motion, modes, horizon } = run;
    // Cables are blue and orange; red and the line's width show how many of them are taut.
    const styles = [
      [colours.ink, 1.1],
      [colours.strained, 2.2],
      [colours.strained, 4.6],
    ];
    const [from, to] = this.rows;
    context.lineJoin = "round";
    let i = from;
    let leg = 0;
    while (i < to - 1) {
      const t = motion.t[i];
      while (leg < modes.t_end.length - 1 && modes.t_end[leg] <= t) leg += 1;
      const lost = horizon.t !== null && t >= horizon.t;
      // After the listed modes the tensions of each row show how many cables are taut.
      const listed = run.listed(t);
      const modeEnd = listed ? (modes.t_end[leg] ?? Infinity) : t;
      const until = Math.min(modeEnd, lost || horizon.t === null ? Infinity : horizon.t);
      let j = i + 1;
      while (j < to - 1 && motion.t[j] < until) j += 1;
      const pulling = [motion.T1[i], motion.T2[i]].filter((tension) => tension > 0);
      const taut = listed ? (modes.taut[leg] ?? []) : pulling;
      const [stroke, width] = styles[Math.min(taut.length, 2)];
      context.strokeStyle = lost ? colours.past : stroke;
      context.lineWidth = width;
      drawColumn(context, this.frame, ...this.#columns(motion), i, j + 1);
      i = j;
    }
  }

  #marks(context, colours) {
    const { t, before_x: x, before_y: y, cable } = this.run.impacts;
    if (t.length > MOST_MARKS) return;
    const [first, last] = [this.run.motion.t[this.rows[0]], this.run.motion.t[this.rows[1] - 1]];
    context.lineWidth = 1.2;
    const shown = t.flatMap((time, i) =>
      time < first || time > last ? [] : [{ cable: cable[i], x: this.frame.x(x[i]), y: this.frame.y(y[i]) }],
    );
    drawMarks(context, shown, (one) => colours[`cable-${one}`], 2.3);
  }

  #ghost(context, colours) {
    if (!this.run.ghost) return;
    const { t } = this.run.ghost.motion;
    const [x, y] = this.#columns(this.run.ghost.motion);
    const [from, to] = rowsWithin(t, [this.run.motion.t[this.rows[0]], this.run.motion.t[this.rows[1] - 1]]);
    context.strokeStyle = colours.ghost;
    context.lineWidth = 1.1;
    context.setLineDash([5, 3]);
    drawColumn(context, this.frame, x, y, from, to);
    context.setLineDash([]);
  }

  /** The legend, with entries only for what occurs in the time shown. */
  #legend() {
    const { run } = this;
    const { t } = run.motion;
    const [first, last] = [t[this.rows[0]], t[this.rows[1] - 1]];
    const moded = (n) =>
      run.modes.taut.some(
        (taut, i) =>
          Math.min(taut.length, 2) === n &&
          run.modes.t_end[i] > run.modes.t_start[i] &&
          run.modes.t_start[i] < last &&
          run.modes.t_end[i] > first,
      );
    const { cable: cables } = run.impacts;
    const struck = (cable) => run.impacts.t.some((time, i) => cables[i] === cable && time >= first && time <= last);
    const pulls = (n) =>
      run.cut !== null &&
      t.slice(this.rows[0], this.rows[1]).some((time, i) => {
        const row = this.rows[0] + i;
        const pulling = [run.motion.T1[row], run.motion.T2[row]].filter((tension) => tension > 0);
        return !run.listed(time) && pulling.length === n;
      });
    const occurs = (n) => moded(n) || pulls(n);
    const there = {
      "snap-1": this.#isPath && struck(1),
      "snap-2": this.#isPath && struck(2),
      "taut-1": this.#isPath && this.#passes(0),
      "taut-2": this.#isPath && this.#passes(1),
      upright: this.#isPath && run.geometry.cables.some((cable) => this.#boundary(cable, 0).some(this.#within)),
      slack: occurs(0) && (occurs(1) || occurs(2)),
      sliding: occurs(1),
      rocking: occurs(2),
      lost: run.horizon.t !== null && run.horizon.t < last,
      ghost: Boolean(run.ghost),
    };
    for (const entry of this.legend) entry.hidden = !there[entry.dataset.of];
  }

  #within = ([x, y]) => {
    const { left, top, width, height } = this.frame;
    return x >= left && x <= left + width && y >= top && y <= top + height;
  };

  /** Whether the boundary of a cable is in the frame at any time shown. */
  #passes(cable) {
    const { theta } = this.run.motion;
    const [from, to] = this.rows;
    const step = Math.max(1, Math.floor((to - from) / LOOKS));
    for (let i = from; i < to; i += step) {
      if (this.#boundary(this.run.geometry.cables[cable], theta[i]).some(this.#within)) return true;
    }
    return false;
  }

  /** I at the start and E at the end of the motion: the letters of the thesis's figures. */
  #letters(context, colours) {
    const { t } = this.run.motion;
    const [x, y] = this.#columns(this.run.motion);
    /** @type {[string, number][]} */
    const ends = [
      ["I", 0],
      ["E", t.length - 1],
    ];
    context.font = FONT;
    for (const [letter, i] of ends) {
      if (i < this.rows[0] || i >= this.rows[1]) continue;
      const [px, py] = [this.frame.x(x[i]), this.frame.y(y[i])];
      context.beginPath();
      context.arc(px, py, 2.6, 0, 2 * Math.PI);
      context.fillStyle = colours.ink;
      context.fill();
      context.strokeStyle = colours.panel;
      context.lineWidth = 3;
      context.strokeText(letter, px + 6, py - 5);
      context.fillText(letter, px + 6, py - 5);
    }
  }

  /** The body's centre and the boundaries at its rotation, at the time cursor, and the hovered point. */
  cursor(t, hover) {
    if (!this.run) return;
    const { left, top, width, height } = this.frame;
    set(this.window, { x: left, y: top, width, height, viewBox: `${left} ${top} ${width} ${height}` });
    const now = this.run.at(this.run.nearest(t));
    this.run.geometry.cables.forEach((cable, i) => {
      const points = this.#isPath ? this.#boundary(cable, now.theta) : [];
      set(this.boundaries[i], { points: points.map((point) => point.map(short).join()).join(" ") });
    });
    const place = (moment) => ({ cx: this.frame.x(moment[this.plane.x]), cy: this.frame.y(moment[this.plane.y]) });
    set(this.now, place(now));
    const read = hover ? this.run.at(hover.t) : now;
    this.hovered.style.display = hover ? "" : "none";
    set(this.hovered, place(read));
    const [across, up] = [read[this.plane.x], read[this.plane.y]].map((value) => fixed(value, 4));
    const words = `${about(read)}t ${fixed(read.t, 3)}  ${this.plane.x} ${across}  ${this.plane.y} ${up}`;
    if (this.reading.value !== words) this.reading.value = words;
  }
}

/**
 * The times k 2π/|Ω| within a range of time; of too many to be drawn every second, third and so on.
 * @param {number} omega
 * @param {number[]} range
 */
export function sectionTimes(omega, [from, to]) {
  if (omega === 0) return [];
  const period = (2 * Math.PI) / Math.abs(omega);
  const first = Math.ceil(from / period - 1e-9);
  const count = Math.max(Math.floor(to / period) - first + 1, 0);
  const step = Math.ceil(count / MOST_POINTS) || 1;
  return Array.from({ length: Math.ceil(count / step) }, (_, k) => (first + k * step) * period);
}

const short = (px) => Math.round(px * 10) / 10;

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}

/**
 * The first row of a range of time, and the one after its last.
 * @param {number[]} t
 * @param {number[]} range
 * @returns {[number, number]}
 */
function rowsWithin(t, [from, to]) {
  let [low, high] = [0, t.length];
  while (low < high - 1 && t[low] < from) low += 1;
  while (high > low + 1 && t[high - 1] > to) high -= 1;
  return [low, high];
}
