// The state of the page, from which everything that it shows follows; the link holds all of it.

export const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20];
const PICTURES = ["real", "thesis"];
const VIEWS = ["whole", "close"];
const PLANES = ["path", "x", "y", "theta", "section"];
export const MOST_PINS = 3;
export const MOST_CELLS = 200;

const BEGINNING = {
  t: 0,
  speed: 1,
  picture: "real",
  view: "whole",
  plane: "path",
  loop: false,
  zoom: null,
  pins: [],
  ghost: null,
  window: null,
  map: null,
  basin: null,
};

/** Fields that are set together, and the listeners to them. */
export class ObservableState {
  listeners = [];

  /** Calls back with the names of the changed fields. */
  listen(listener) {
    this.listeners.push(listener);
  }

  set(changes) {
    const changed = Object.keys(changes).filter((name) => !same(this[name], changes[name]));
    if (changed.length === 0) return;
    Object.assign(this, changes);
    for (const listener of this.listeners) listener(new Set(changed));
  }
}

/** The state and its listeners. */
export class State extends ObservableState {
  /** The view of the run: the fields of BEGINNING. */
  t = BEGINNING.t;
  speed = BEGINNING.speed;
  picture = BEGINNING.picture;
  view = BEGINNING.view;
  plane = BEGINNING.plane;
  loop = BEGINNING.loop;
  zoom = BEGINNING.zoom;
  /** @type {object[]} */
  pins = BEGINNING.pins;
  ghost = BEGINNING.ghost;
  window = BEGINNING.window;
  map = BEGINNING.map;
  basin = BEGINNING.basin;

  constructor(schema) {
    super();
    this.schema = schema;
    this.defaults = Object.fromEntries(schema.keys.map((key) => [key.name, key.default]));
    this.derived = new Set(schema.keys.filter((key) => key.derived).map((key) => key.name));
    this.values = { ...schema.start.values };
  }

  /** Sets some keys; null, or the default, removes one. `more` fields of the state change with them. */
  setValues(changes, more = {}) {
    const values = { ...this.values };
    for (const [name, value] of Object.entries(changes)) {
      if (value === null || (value === this.defaults[name] && !this.derived.has(name))) delete values[name];
      else values[name] = value;
    }
    this.set({ values, ...more });
  }

  /** The value of a key; null if it is derived from others. */
  value(name) {
    return this.values[name] ?? (this.derived.has(name) ? null : this.defaults[name]);
  }

  /** The built-in case with exactly these values, or the case with which the program was started. */
  get caseName() {
    const { start, cases } = this.schema;
    const all = [start, ...cases.map(({ code, values }) => ({ name: code, values }))];
    return all.find(({ values }) => same(values, this.values))?.name ?? null;
  }

  /** The state as the fragment of a link. */
  toFragment() {
    const parts = Object.entries(this.values).map(([name, value]) => [name, String(value)]);
    const add = (name, value, beginning) => value !== beginning && parts.push([name, String(value)]);
    parts.push(["t", String(this.t)]);
    add("speed", this.speed, BEGINNING.speed);
    add("picture", this.picture, BEGINNING.picture);
    add("view", this.view, BEGINNING.view);
    add("plane", this.plane, BEGINNING.plane);
    add("loop", this.loop, BEGINNING.loop);
    for (const values of this.pins) parts.push(["pin", JSON.stringify(values)]);
    add("ghost", this.ghost, BEGINNING.ghost);
    if (this.zoom) parts.push(["zoom", this.zoom.join(",")]);
    if (this.window) parts.push(["window", this.window.join(",")]);
    if (this.map) parts.push(["map", mapToText(this.map)]);
    if (this.basin) parts.push(["basin", basinToText(this.basin)]);
    return parts.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&");
  }

  /**
   * Takes the whole state of a fragment; missing fields have their initial values. Returns what could not be read.
   */
  readFragment(fragment) {
    if (!fragment) {
      this.set({ ...BEGINNING, values: { ...this.schema.start.values } });
      return [];
    }
    const next = { ...BEGINNING, values: {} };
    const broken = [];
    for (const part of fragment.split("&")) {
      const [name, ...rest] = part.split("=");
      const text = decode(rest.join("="));
      const key = this.schema.keys.find((one) => one.name === name);
      const value = text === null ? undefined : key ? readValue(key, text) : readView(name, text, this.schema);
      if (value === undefined) broken.push(part);
      else if (name === "pin") next.pins = [...next.pins, value].slice(-MOST_PINS);
      else if (key) next.values[name] = value;
      else next[name] = value;
    }
    for (const name of Object.keys(next.values)) {
      if (next.values[name] === this.defaults[name] && !this.derived.has(name)) delete next.values[name];
    }
    this.set(next);
    return broken;
  }
}

export const same = (one, other) => JSON.stringify(sorted(one)) === JSON.stringify(sorted(other));

function sorted(value) {
  if (value === null || typeof value !== "object" || Array.isArray(value)) return value;
  return Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)));
}

export function decode(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return null;
  }
}

/** A decimal number, with a hyphen or a minus sign; other notations of JavaScript are not accepted. */
const DECIMAL = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;

export function finite(text) {
  const plain = text.trim().replaceAll("\u2212", "-");
  const value = DECIMAL.test(plain) ? Number(plain) : NaN;
  return Number.isFinite(value) ? value : undefined;
}

/** The value of a key from text; undefined if it is invalid. The server decides whether it is allowed. */
export function readValue(key, text) {
  if (key.kind.type === "flag") return text === "true" ? true : text === "false" ? false : undefined;
  if (key.kind.type === "choice") return key.kind.options.includes(text) ? text : undefined;
  if (key.kind.type === "text") return undefined;
  return finite(text);
}

function readView(name, text, schema) {
  const number = finite(text);
  const oneOf = (list, value) => (list.includes(value) ? value : undefined);
  switch (name) {
    case "t":
      return number >= 0 ? number : undefined;
    case "speed":
      return oneOf(SPEEDS, number);
    case "picture":
      return oneOf(PICTURES, text);
    case "view":
      return oneOf(VIEWS, text);
    case "ghost":
      // The server decides how far away it may start.
      return number;
    case "window": {
      const [from, to] = text.split(",").map(finite);
      return from >= 0 && to > from ? [from, to] : undefined;
    }
    case "plane":
      return oneOf(PLANES, text);
    case "loop":
      return text === "true" || undefined;
    case "pin":
      return pinFromText(text, schema);
    case "zoom": {
      const [k, x, y] = text.split(",").map(finite);
      return k > 1 && x !== undefined && y !== undefined ? [k, x, y] : undefined;
    }
    case "map":
      return mapFromText(text, schema);
    case "basin":
      return basinFromText(text, schema);
    default:
      return undefined;
  }
}

/** The values of a pinned run: valid keys and values. */
function pinFromText(text, schema) {
  try {
    const values = Object.entries(JSON.parse(text));
    const legal = ([name, value]) => {
      const key = schema.keys.find((one) => one.name === name);
      return key !== undefined && readValue(key, String(value)) === value;
    };
    return values.every(legal) ? Object.fromEntries(values) : undefined;
  } catch {
    return undefined;
  }
}

export const isCount = (count) => Number.isInteger(count) && count >= 2 && count <= MOST_CELLS;

/** Whether an axis has a range and a number of cells. */
export const isAxis = ({ low, high, count }) => high > low && isCount(count);

const axisToText = ({ key, low, high, count }) => [key, low, high, count].join(",");
const mapToText = ({ x, y, colour }) => [axisToText(x), axisToText(y), colour].join(",");

const basinToText = ({ x, y, over }) => [x, y, over].map(axisToText).join(",");

function axisFromParts([key, ...rest], schema) {
  const [low, high, count] = rest.map(finite);
  const numeric = schema.keys.some((one) => one.name === key && one.kind.type === "number");
  return numeric && isAxis({ low, high, count }) ? { key, low, high, count } : undefined;
}

function basinFromText(text, schema) {
  const parts = text.split(",");
  const [x, y, over] = [0, 4, 8].map((from) => axisFromParts(parts.slice(from, from + 4), schema));
  const different = new Set([x?.key, y?.key, over?.key]).size === 3;
  return parts.length === 12 && x && y && over && different ? { x, y, over } : undefined;
}

function mapFromText(text, schema) {
  const parts = text.split(",");
  const [x, y] = [0, 4].map((from) => axisFromParts(parts.slice(from, from + 4), schema));
  const colour = parts[8];
  const known = schema.map.some(({ name }) => name === colour);
  return parts.length === 9 && x && y && x.key !== y.key && known ? { x, y, colour } : undefined;
}
