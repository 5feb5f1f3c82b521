// The state of the page of a structure: the open case, the changes of it, and the view.

import { SPEEDS, ObservableState, decode, finite, readValue } from "./state.js";
import { fieldText } from "./formatting.js";

const BEGINNING = {
  values: {},
  water: null,
  t: 0,
  speed: 1,
  loop: true,
  elastic: true,
  window: null,
  zoom: null,
};
const WATERS = ["still", "wave", "sea"];

/** Keys by path: `wave.height`, `line.length` of all lines, `line.2.length` of one. */
function keysOf(schema, lines) {
  const paths = ({ name, many }) =>
    many ? [name, ...Array.from({ length: lines }, (_, i) => `${name}.${i + 1}`)] : [name];
  return schema.tables.flatMap((table) =>
    paths(table).flatMap((path) =>
      table.keys.map((key) => ({ ...key, name: `${path}.${key.name}`, table: table.name, under: path })),
    ),
  );
}

export class StructureState extends ObservableState {
  /** The changes, by path. @type {object} */
  values = {};
  /** The kind of waves, if it is another than in the case. @type {string | null} */
  water = null;
  t = 0;
  speed = 1;
  loop = true;
  /** Whether the run on elastic lines is shown, too. */
  elastic = true;
  /** The interval of time that is shown [s]. @type {number[] | null} */
  window = null;
  /** @type {number[] | null} */
  zoom = null;

  /** `file` is the case file if it was opened on the page, `given` its values. */
  constructor(schema, { name, checksum, given, water, lines, floats }, file = null) {
    super();
    this.caseName = name;
    this.checksum = checksum;
    this.given = given;
    this.ownWater = water;
    this.lines = lines;
    this.floats = floats;
    this.file = file;
    this.schema = { ...schema, keys: keysOf(schema, lines) };
    /** Which case a link changes: the name of its file, and what its values are. */
    this.identity = identityOf({ name, given });
  }

  get waterNow() {
    return this.water ?? this.ownWater;
  }

  #key(name) {
    return this.schema.keys.find((key) => key.name === name);
  }

  /** The value of a key: the changed one, that of the case, or the default; null if there is none. */
  value(name) {
    const own = this.values[name];
    if (own !== undefined) return own;
    const [table, number, key] = name.split(".");
    if (this.#isOfAllLines(name)) return this.#ofAllLines(number);
    return (key && this.values[`${table}.${key}`]) ?? this.given[name] ?? this.#key(name)?.default ?? null;
  }

  /** Whether a key of all lines has several values. */
  differs(name) {
    return this.#isOfAllLines(name) && new Set(this.#ofEachLine(name.split(".")[1]).map(fieldText)).size > 1;
  }

  #isOfAllLines(name) {
    return name.split(".").length === 2 && this.#key(name)?.table === "line";
  }

  /** The value that all lines have; null if they differ. */
  #ofAllLines(key) {
    return this.differs(`line.${key}`) ? null : this.#ofEachLine(key)[0];
  }

  #ofEachLine(key) {
    return Array.from({ length: this.lines }, (_, i) => this.value(`line.${i + 1}.${key}`));
  }

  /** Sets some keys; null, or the value of the case, removes a change. */
  setValues(changes, more = {}) {
    const values = { ...this.values };
    for (const [name, value] of Object.entries(changes)) {
      const key = this.#key(name);
      const ofAll = key.table === "line" && key.under === "line";
      // A value for all lines replaces those of the single lines.
      const ending = name.slice("line".length);
      if (ofAll) for (const path of Object.keys(values)) if (path.endsWith(ending)) delete values[path];
      if (value === null || fieldText(value) === fieldText(this.given[name])) delete values[name];
      else values[name] = value;
    }
    this.set({ values, ...more });
  }

  /** The values with waves of another kind, which start with about the height and period of those that they replace. */
  ofWater(water) {
    const value = (name) => Number(this.value(name) ?? 0);
    const values = { ...this.values };
    if (water === "sea" && this.value("sea.hs") === null) {
      values["sea.hs"] = Number(((value("wave.height") || 2) / 1.86).toFixed(1));
      values["sea.tp"] = value("wave.period") || 6;
    }
    if (water === "wave" && this.value("wave.height") === null) {
      values["wave.height"] = Number(((value("sea.hs") || 1) * 1.86).toFixed(1));
      values["wave.period"] = value("sea.tp") || 6;
    }
    return { values, water: water === this.ownWater ? null : water };
  }

  /** The case in a request: changes in the notation of `--set`, those of all lines first. */
  get asked() {
    const order = Object.entries(this.values).sort(([a], [b]) => a.split(".").length - b.split(".").length);
    const other = (name) => ["wave", "sea"].some((water) => water !== this.waterNow && name.startsWith(`${water}.`));
    const set = order.filter(([name]) => !other(name)).map(([name, value]) => `${name}=${fieldText(value)}`);
    // Without a file it is about that of the program, which may be started again with another one.
    const of = this.file ? { file: this.file } : { opened: this.checksum };
    return { ...of, set, water: this.water };
  }

  /** The values by path that changes in the notation of `--set` stand for. */
  valuesOf(set) {
    const pairs = set.map((change) => [change.slice(0, change.indexOf("=")), change.slice(change.indexOf("=") + 1)]);
    return Object.fromEntries(pairs.map(([name, text]) => [name, valueOf(this.#key(name), text)]));
  }

  /** The state as the fragment of a link. */
  toFragment() {
    const changes = Object.entries(this.values).map(([name, value]) => [name, fieldText(value)]);
    const parts = [["case", this.identity], ...changes];
    for (const name of ["water", "speed", "loop", "elastic"]) {
      if (this[name] !== BEGINNING[name]) parts.push([name, String(this[name])]);
    }
    parts.push(["t", String(this.t)]);
    if (this.window) parts.push(["window", this.window.join(",")]);
    if (this.zoom) parts.push(["zoom", this.zoom.join(",")]);
    return parts.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&");
  }

  /**
   * Takes the whole state of a fragment, unless it is that of another case. Returns what could not be read, or the part
   * that names the other case.
   */
  readFragment(fragment) {
    const next = { ...BEGINNING, values: {} };
    const broken = [];
    for (const part of fragment ? fragment.split("&") : []) {
      const [name, ...rest] = part.split("=");
      const text = decode(rest.join("="));
      if (name === "case") {
        if (text === this.identity) continue;
        this.set({ ...BEGINNING, values: {} });
        return [part];
      }
      const key = this.#key(name);
      const value = text === null ? undefined : key ? valueOf(key, text) : readView(name, text);
      if (value === undefined) broken.push(part);
      else if (key) next.values[name] = value;
      else next[name] = value;
    }
    this.set(next);
    return broken;
  }
}

/** The value of a key; text that is none for the page is left to the server. */
const valueOf = (key, text) => readValue(key, text) ?? text;

/** The name of the case in the part of a fragment that names it; undefined for other parts. */
const caseOfLink = (part) => part.match(/^case=(.*?)(:\w*)?$/)?.[1];

/** What was not taken from a link: parts that are not understood, or all of the link of another case. */
export function brokenLinkWords(parts) {
  const other = caseOfLink(decode(parts[0]) ?? "");
  if (other === undefined) return `Not understood in the link, and ignored: ${parts.join(", ")}`;
  return `The link belongs to ${other} with other values than those of the case that is open, and is ignored. Open that file first, then the link.`;
}

/** The name of a file without its folder. */
export const fileName = (name) => name.split(/[\\/]/).at(-1);

/** Which case a link changes: the name of its file, and what its values are. */
export const identityOf = ({ name, given }) => `${fileName(name)}:${shortSum(JSON.stringify(given))}`;

/** The identity of the case that a fragment names; null if it names none. */
export function caseOfFragment(fragment) {
  const part = fragment.split("&").find((one) => one.startsWith("case="));
  return part ? decode(part.slice("case=".length)) : null;
}

/** A short text that differs for different texts (FNV-1a). */
function shortSum(text) {
  let sum = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) sum = Math.imul(sum ^ byte, 0x01000193) >>> 0;
  return sum.toString(36);
}

function readView(name, text) {
  const flag = { true: true, false: false }[text];
  switch (name) {
    case "t":
      return finite(text) >= 0 ? finite(text) : undefined;
    case "speed":
      return SPEEDS.includes(finite(text)) ? finite(text) : undefined;
    case "loop":
    case "elastic":
      return flag;
    case "water":
      return WATERS.includes(text) ? text : undefined;
    case "window": {
      const [from, to] = text.split(",").map(finite);
      return from >= 0 && to > from ? [from, to] : undefined;
    }
    case "zoom": {
      const [k, x, y] = text.split(",").map(finite);
      return k > 1 && x !== undefined && y !== undefined ? [k, x, y] : undefined;
    }
    default:
      return undefined;
  }
}
