// A run from the server's answer: the motion at any time, and the events.

/** The last index whose time is at or before t; times ascend, and may repeat. */
export function lastAtOrBefore(times, t) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Value and derivative of the cubic with these ends and slopes, at the part `u` of an interval of length d. */
export function hermite(p0, v0, p1, v1, d, u) {
  const w = 1 - u;
  const value = w * w * (1 + 2 * u) * p0 + u * u * (3 - 2 * u) * p1 + d * u * w * (w * v0 - u * v1);
  const rate = (6 * u * w * (p1 - p0)) / d + w * (1 - 3 * u) * v0 + u * (3 * u - 2) * v1;
  return [value, rate];
}

/** Rows that are further apart than this [T] do not show the motion: more are asked for. */
const FAR_T = 0.25;

/** Two runs have separated if they differ by this. */
const SEPARATED = 1e-3;

const COORDINATES = [
  ["x", "vx"],
  ["y", "vy"],
  ["theta", "vtheta"],
];

/** A motion from columns; at the instant of an event the state just after it. */
export class Motion {
  constructor(columns) {
    this.columns = columns;
    this.t = columns.t;
  }

  at(t) {
    const c = this.columns;
    const i = lastAtOrBefore(this.t, t);
    const j = Math.min(i + 1, this.t.length - 1);
    const d = this.t[j] - this.t[i];
    const u = d > 0 ? Math.min((t - this.t[i]) / d, 1) : 0;
    const rough = u > 0 && u < 1;
    const moment = { t, rough, far: rough && d > FAR_T };
    for (const [place, speed] of COORDINATES) {
      const known = u === 0;
      [moment[place], moment[speed]] = known
        ? [c[place][i], c[speed][i]]
        : hermite(c[place][i], c[speed][i], c[place][j], c[speed][j], d, u);
    }
    const along = (column) => column[i] + (column[j] - column[i]) * u;
    moment.tensions = [along(c.T1), along(c.T2)];
    moment.energy = along(c.energy);
    return moment;
  }
}

export class Run {
  /** The server's answer. @type {any} */
  values;
  /** @type {any} */
  geometry;
  /** @type {any} */
  end;
  /** How its neighbours end, in words, if they end alike; null if they have to be run. @type {string | null} */
  outcome;
  /** @type {any} */
  norms;
  /** The known digits of each, as text. @type {any} */
  norms_known;
  /** @type {any} */
  horizon;
  /** @type {any} */
  modes;
  /** @type {any} */
  impacts;
  /** The number of impacts: impulses that passed into a taut cable have a row, but do not count. */
  snaps = 0;
  /** @type {any} */
  cut;
  /** @type {any} */
  motion;
  /** @type {any} */
  ghost;
  /** @type {any} */
  ghost_error;
  shell = "";
  python = "";
  /** The times of all events, computed when they are first needed. @type {number[] | undefined} */
  eventTimes;
  /** The motion at exactly some times, as it was asked for. @type {Map<number, any>} */
  instants = new Map();
  /** The number of impacts up to each row, computed when it is first needed. @type {number[] | undefined} */
  snapCounts;

  constructor(answer) {
    Object.assign(this, answer);
    this.motionAt = new Motion(answer.motion);
    this.ghostAt = answer.ghost ? new Motion(answer.ghost.motion) : null;
    this.tEnd = answer.end.t;
    this.events = listEvents(answer);
    this.stops = [...new Set(this.events.map((event) => event.t))];
    this.hardest = answer.impacts.impulse.reduce((most, p) => Math.max(most, p), 0);
    const { taut, t_start, t_end } = answer.modes;
    this.timeTaut = taut.reduce((sum, set, i) => sum + (set.length ? t_end[i] - t_start[i] : 0), 0);
    this.mostTension = Math.max(largest(answer.motion.T1), largest(answer.motion.T2));
    this.reach = { x: ends(answer.motion.x), y: ends(answer.motion.y) };
  }

  /** The ghost at a time; null if there is none, or it has ended longer before than what separates the two. */
  ghostMoment(t) {
    return this.ghostAt && t <= this.ghost.end.t + SEPARATED ? this.ghostAt.at(t) : null;
  }

  at(t) {
    const exact = this.instants.get(t);
    const moment = exact ? new Motion(exact.motion).at(t) : this.motionAt.at(t);
    moment.taut = this.tautAt(t);
    moment.force = this.forceAt(t);
    return moment;
  }

  /** The forcing: f_x = f_o cos Ωt, f_y = ν f_o sin Ωt. */
  forceAt(t) {
    const { f_o, nu, omega } = this.values;
    return [f_o * Math.cos(omega * t), nu * f_o * Math.sin(omega * t)];
  }

  /** Which cables are taut, counted from 1; null where that is not known. */
  tautAt(t) {
    const exact = this.instants.get(t);
    if (exact) return exact.taut;
    if (!this.listed(t)) return null;
    const { taut, t_start } = this.modes;
    return taut[lastAtOrBefore(t_start, t)] ?? [];
  }

  /** The nearest time whose motion the answer has. */
  nearest(t) {
    return Math.min(t, this.tEnd);
  }

  /** The interval that is shown, which may be chosen. */
  interval(chosen) {
    return chosen ?? [0, this.tEnd];
  }

  /** The interval that is shown next: a chosen one needs no other answer. */
  intervalToCome(chosen) {
    return this.interval(chosen);
  }

  /** Whether the answer lists all events up to a time; of a long run it lists only the first. */
  listed(t) {
    return !this.cut || t < this.cut.until;
  }

  beyond(t) {
    return this.horizon.t !== null && t > this.horizon.t;
  }

  /** The next stop after t, or the end; the one before t, or the start. */
  nextStop(t) {
    return this.stops[Math.min(this.stopBefore(t, true) + 1, this.stops.length - 1)];
  }

  previousStop(t) {
    return this.stops[Math.max(this.stopBefore(t, false), 0)];
  }

  /** Index of the last stop before t, or at it; −1 where there is none. */
  stopBefore(t, orAt) {
    const i = lastAtOrBefore(this.stops, t);
    const counts = orAt ? this.stops[i] <= t : this.stops[i] < t;
    return counts ? i : i - 1;
  }

  /** Index of the last event at or before t. */
  eventAt(t) {
    let i = lastAtOrBefore((this.eventTimes ??= this.events.map((event) => event.t)), t);
    while (i > 0 && this.events[i - 1].t === this.events[i].t) i -= 1;
    return i;
  }

  /** Index of the last impact at or before t; −1 before the first. */
  latestImpact(t) {
    const times = this.impacts.t;
    return times.length > 0 && times[0] <= t ? lastAtOrBefore(times, t) : -1;
  }

  /** The number of impacts at or before t, without impulses that passed into a taut cable. */
  snapsUntil(t) {
    let count = 0;
    this.snapCounts ??= this.impacts.v_n.map((v) => (count += v > 0 ? 1 : 0));
    return this.snapCounts[this.latestImpact(t)] ?? 0;
  }

  /** Impacts with from <= t <= to, the latest first, as indices. */
  impactsWithin(from, to) {
    const times = this.impacts.t;
    const found = [];
    for (let i = this.latestImpact(to); i >= 0 && times[i] >= from; i -= 1) found.push(i);
    return found;
  }
}

/** The least and the largest of a column. */
export const ends = (column) => [
  column.reduce((least, value) => Math.min(least, value), Infinity),
  column.reduce((most, value) => Math.max(most, value), -Infinity),
];

const largest = (column) => column.reduce((most, value) => Math.max(most, value ?? 0), 0);

function listEvents(answer) {
  const { impacts, modes, horizon, end, ghost } = answer;
  const events = [{ t: 0, kind: "start" }];
  impacts.t.forEach((t, i) => events.push({ t, kind: "impact", impact: i }));
  modes.t_start.forEach((t, i) => {
    if (i > 0) events.push({ t, kind: "mode", taut: modes.taut[i] });
  });
  if (horizon.t !== null && horizon.t > 0 && horizon.t < end.t) events.push({ t: horizon.t, kind: "horizon" });
  if (ghost && ghost.parts_at !== null && ghost.parts_at < end.t) events.push({ t: ghost.parts_at, kind: "parts" });
  events.push({ t: end.t, kind: "end" });
  // Sorting keeps the order of events at one instant: impact, mode, horizon, end.
  return events.sort((one, other) => one.t - other.t);
}
