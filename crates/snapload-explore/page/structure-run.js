// A structure's run from the server's answer: the motion at any time of the interval that is shown, in metres,
// kilonewtons and seconds, with z upwards from the still water.

import { ends, hermite, lastAtOrBefore } from "./run.js";
import { number } from "./formatting.js";

const COORDINATES = [
  ["x", "vx", "x"],
  ["z", "vz", "y"],
  ["theta", "vtheta", "theta"],
];

/** A motion from columns. The scene's y is z. */
export class StructureMotion {
  constructor(columns) {
    this.columns = columns;
    this.t = columns.t;
  }

  at(t) {
    const c = this.columns;
    const i = lastAtOrBefore(c.t, t);
    const j = Math.min(i + 1, c.t.length - 1);
    const d = c.t[j] - c.t[i];
    const u = d > 0 ? Math.min(Math.max((t - c.t[i]) / d, 0), 1) : 0;
    const outside = t < c.t[0] || t > c.t[c.t.length - 1];
    /** @type {any} */
    const moment = { t, rough: outside || (u > 0 && u < 1) };
    for (const [place, speed, name] of COORDINATES) {
      moment[name] =
        u === 0 ? c[place][i] : hermite(c[place][i], c[speed][i], c[place][j], c[speed][j], d, u)[0];
    }
    moment.tensions = c.tensions.map((column) => column[i] + (column[j] - column[i]) * u);
    return moment;
  }
}

/** The values of a line's keys. */
const ofLine = (line) => ({
  stiffness: line.stiffness_n,
  spring_rate: line.stiffness_n && line.stiffness_n / line.length_m,
  mass_per_length: line.mass_per_length_kg_m,
  breaking_load: line.breaking_load_n,
});

export class StructureRun {
  /** The case that was asked for. @type {any} */
  ofCase;
  /** The server's answer. @type {any} */
  assessment;
  /** @type {any} */
  geometry;
  /** @type {any} */
  snaps;
  /** @type {any} */
  modes;
  /** @type {any} */
  motion;
  /** @type {number[][]} */
  waves = [];
  /** @type {number[]} */
  window = [0, 0];
  summary = "";
  standing = "";
  /** @type {string | null} */
  rebound = null;
  /** @type {string | null} */
  nearby_waves = null;
  preview = false;
  lasts_s = 0;
  transient_s = 0;
  shell = "";
  /** The motion at exactly some times, as it was asked for. @type {Map<number, any>} */
  instants = new Map();
  python = "";
  /** The run on elastic lines, once it is computed. @type {any} */
  elastic = null;
  /** @type {StructureMotion | null} */
  elasticAt = null;

  constructor(answer, ofCase = null) {
    Object.assign(this, answer);
    this.ofCase = ofCase;
    this.motionAt = new StructureMotion(answer.motion);
    this.tEnd = answer.assessment.end.t_s;
    this.horizon = { t: answer.assessment.trust.horizon_s };
    this.lines = answer.assessment.lines;
    this.stops = answer.snaps.t;
    const { number, t, all } = answer.snaps;
    const gap = number.findIndex((count, i) => count !== i + 1);
    /** The time up to which all snaps are listed, if not to the end. @type {number | null} */
    this.listedUntil = number.length === all ? null : (t[(gap < 0 ? number.length : gap) - 1] ?? 0);
    const { x, z, tensions } = answer.motion;
    this.reach = { x: ends(x), z: ends(z) };
    this.mostTension = tensions.reduce((most, column) => Math.max(most, ends(column)[1]), 0);
    const { utilisation, peak, speed } = answer.snaps;
    // One measure for all: the utilisation if known, or the tension, or the speed.
    this.hardness = [utilisation, peak].find((column) => !column.includes(null)) ?? speed;
    this.hardest = this.hardness.reduce((most, value) => Math.max(most, value), 0);
  }

  /** Sets the same run on elastic lines, for comparison; null for none. */
  setElastic(answer) {
    this.elastic = answer;
    this.elasticAt = answer && answer.motion.t.length ? new StructureMotion(answer.motion) : null;
  }

  /** Up to when the motion on elastic lines is known [s]. */
  get elasticHorizon() {
    return this.elastic?.elastic.trust.horizon_s ?? Infinity;
  }

  /** The run on elastic lines at a time; null if there is none, or it has ended before. */
  elasticMoment(t) {
    return this.elasticAt && t <= this.elastic.elastic.end.t_s ? this.elasticAt.at(t) : null;
  }

  at(t) {
    const exact = this.instants.get(t);
    const moment = exact ? new StructureMotion(exact.motion).at(t) : this.motionAt.at(t);
    moment.taut = exact?.taut ?? this.tautAt(t);
    moment.surface = this.surface(this.geometry.rest[0], t);
    return moment;
  }

  /** Which lines are taut, counted from 1. */
  tautAt(t) {
    const { t_start, taut } = this.modes;
    return t_start.length ? (taut[lastAtOrBefore(t_start, t)] ?? []) : [];
  }

  /** The water's surface above a place: sums of A sin(ωt − kx + ε). */
  surface(x, t) {
    let sum = 0;
    for (const [amplitude, omega, k, phase] of this.waves) {
      sum += amplitude * Math.sin(omega * t - k * (x - this.geometry.rest[0]) + phase);
    }
    return sum;
  }

  /** The nearest time whose motion the answer has: until another interval arrives, one of the interval before. */
  nearest(t) {
    const [from, to] = this.window;
    return Math.min(Math.max(t, from), to, this.tEnd);
  }

  /** The interval that is shown. */
  interval() {
    return this.window;
  }

  /** The interval that is shown once the answers on their way are there. */
  intervalToCome(chosen) {
    // One past the beginning that is run waits for the whole record.
    return chosen && !this.isBeyond(chosen[1]) ? chosen : this.window;
  }

  /** Whether the answer has the other runs: of other restitutions always, in waves of other waves and neighbours. */
  get hasOtherRuns() {
    return this.rebound !== null;
  }

  /** Whether a time is in the part of a record that is not run yet. */
  isBeyond(t) {
    return this.preview && t > this.tEnd;
  }

  beyond(t) {
    return this.horizon.t !== null && t > this.horizon.t;
  }

  /** The next stop after t, or the end; null where snaps in between may not be listed. */
  nextStop(t) {
    const i = this.latestSnap(t);
    return this.#followsAt(i + 1) ? (this.stops[i + 1] ?? this.tEnd) : null;
  }

  /** The one before t, or the start; null as above. */
  previousStop(t) {
    const i = this.stops.findLastIndex((stop) => stop < t);
    return this.#followsAt(i + 1) ? (this.stops[i] ?? 0) : null;
  }

  /** Whether no snap is left out between a row of the list, or its end, and the row before. */
  #followsAt(i) {
    const { number, all } = this.snaps;
    return (number[i] ?? all + 1) === (number[i - 1] ?? 0) + 1;
  }

  /** Index of the last snap at or before t; −1 before the first. */
  latestSnap(t) {
    const { t: times } = this.snaps;
    return times.length > 0 && times[0] <= t ? lastAtOrBefore(times, t) : -1;
  }

  /** The number of snaps at or before t in words; of many snaps some are not listed, and not known to the page. */
  snapsUntil(t) {
    const { number, all } = this.snaps;
    const i = this.latestSnap(t);
    return `${this.#followsAt(i + 1) ? "" : "past "}snap ${number[i] ?? 0} of ${all}`;
  }

  /** Snaps with from <= t <= to, the latest first, as indices. */
  snapsWithin(from, to) {
    const found = [];
    for (let i = this.latestSnap(to); i >= 0 && this.snaps.t[i] >= from; i -= 1) found.push(i);
    return found;
  }

  /** The number of snaps of 1 cm/s or more, and whether impacts of taut lines are among them. */
  get snapsInWords() {
    if (this.snaps.jolt.includes(true)) return `${this.snaps.all} snaps and impacts while taut`;
    return `${this.snaps.all} ${this.snaps.all === 1 ? "snap" : "snaps"}`;
  }

  /** The values of keys that the case leaves out, as far as the answer has them. */
  effective(state) {
    const { body } = this.assessment;
    /** @type {[string, any][]} */
    const lines = this.lines.map((line, i) => [`line.${i + 1}`, line]);
    const all = [
      ["run.duration", this.lasts_s],
      ["run.transient", this.transient_s],
      ["body.moment_of_inertia", body.moment_of_inertia_kg_m2],
      ["body.added_mass", `[${[...body.added_mass_kg, body.added_inertia_kg_m2].map((v) => number(v, 6)).join(", ")}]`],
      ["body.height", this.geometry.height],
      ...lines.flatMap(([path, line]) => Object.entries(ofLine(line)).map(([key, value]) => [`${path}.${key}`, value])),
      // For all lines at once only the values that they share.
      ...Object.entries(ofLine(this.lines[0]))
        .filter(([key, value]) => this.lines.every((line) => ofLine(line)[key] === value))
        .map(([key, value]) => [`line.${key}`, value]),
    ];
    return Object.fromEntries(all.filter(([name, value]) => value !== null && state.value(name) === null));
  }
}
