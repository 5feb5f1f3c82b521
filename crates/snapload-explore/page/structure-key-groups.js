// The keys of a structure in groups, those that are changed most often first.

import { isRange } from "./controls.js";
import { fieldText, fixed } from "./formatting.js";
import { fileName } from "./structure-state.js";

const WAVES = { wave: "Regular wave", sea: "Irregular sea" };
/** The keys that are shown for each line. */
const OF_ONE_LINE = ["anchor", "fairlead", "length", "diameter"];
/** The range of a slider as parts of the case's value, if the key has no usual range. */
const AROUND = [0.5, 1.5];

/** Groups of keys for the controls. Files named in the case can not be changed here. */
export function structureKeyGroups(state) {
  const { keys } = state.schema;
  const under = (path) => keys.filter((key) => key.under === path).map((key) => ({ ...ranged(state, key), of: whose(path, state) }));
  const waves = Object.entries(WAVES).map(([name, title]) => ({
    title,
    keys: under(name),
    open: true,
    water: name,
    more: name === "sea" ? [anotherSea(state)] : [],
  }));
  const wide = matchMedia("(min-width: 700px)").matches;
  const one = Array.from({ length: state.lines }, (_, i) => ({
    title: `Line ${i + 1} alone`,
    keys: under(`line.${i + 1}`).filter((key) => OF_ONE_LINE.includes(key.name.split(".")[2])),
    open: false,
  }));
  // Anchors and fairleads can not be set for all lines at once.
  const all = under("line").filter((key) => !["line.anchor", "line.fairlead"].includes(key.name));
  return [
    ...waves,
    { title: state.lines > 1 ? "All lines" : "The line", keys: all, open: wide },
    ...one,
    { title: "Run", keys: under("run"), open: wide },
    { title: "Body", keys: under("body"), open: false },
    { title: "Site", keys: under("site"), open: false },
    { title: "Design checks", keys: under("design"), open: false },
  ];
}

/** Of which lines a key is, where several have the same one. */
function whose(path, { lines }) {
  const [table, number] = path.split(".");
  if (table !== "line" || lines === 1) return "";
  return number ? `line ${number} alone` : "all lines";
}

/** A key with the range of its slider: about the case's value if the key has no usual range. */
function ranged(state, key) {
  const value = state.value(key.name);
  if (key.kind.type === "count" || key.usual || !(typeof value === "number" && value > 0)) return key;
  const { low: least, high: most } = key.kind;
  const [low, high] = AROUND.map((part) => Number(Math.min(Math.max(part * value, least), most).toPrecision(2)));
  return isRange(low, high) ? { ...key, usual: { low, high } } : key;
}

/** A button for the next seed: the same sea with other phases. */
function anotherSea(state) {
  const button = Object.assign(document.createElement("button"), {
    type: "button",
    className: "another-sea",
    textContent: "Another sea like this",
    title: "The next seed: the same spectrum with other phases",
  });
  button.addEventListener("click", () => state.setValues({ "sea.seed": Number(state.value("sea.seed")) + 1 }));
  return button;
}

/** Why a key is not available in the current case. */
export function reasonUnavailable(name, state) {
  if (name.startsWith("body.added_mass") && state.floats) return "[float] gives the added mass";
  if (name === "body.height" && state.value("body.shape") !== "rectangle") return "a circle has only a width";
  return undefined;
}

/** More changes are counted and not named in a film. */
const LONGEST_CHANGES = 60;

/** The line in each picture of a film: the case, what is changed in it, the time, and the speed. */
export function filmCaption(state, { ofCase }, t, speed) {
  const { set, water } = ofCase;
  const changes = [water && `water: ${water}`, changesText(state.valuesOf(set))].filter(Boolean).join(", ");
  const count = set.length + (water ? 1 : 0);
  const changed = changes.length > LONGEST_CHANGES ? `${count} changes` : changes;
  const what = [fileName(state.caseName), changed].filter(Boolean).join(", ");
  return `${what} · t = ${fixed(t, 2)} s · ${speedWords(speed)}`;
}

/** How fast time passes. */
export const speedWords = (speed) => (speed === 1 ? "real time" : `${speed} times`);

/** The changes as text, such as `wave.height = 2.5`. */
export const changesText = (values) =>
  Object.entries(values)
    .map(([name, value]) => `${name} = ${fieldText(value)}`)
    .join(", ");
