// A slider and a field for every key, from the schema.

import { setAttributes, setProperties } from "./dom.js";
import { fieldText, withSymbols, symbolHtml, unitText } from "./formatting.js";
import { readValue } from "./state.js";

const GROUPS = [
  ["forcing", "Forcing"],
  ["cables", "Cables"],
  ["body", "Body"],
  ["start", "Start"],
  ["stops", "Stops"],
];

/** Texts longer than this do not fit next to their label. */
const LONG_OPTION = 8;

/** The most characters of an end of a slider that its field shows. */
const LONGEST_END = 5;

/** Kinds of values that are not always a single number, which need more room and the whole meaning of their key. */
const ROOMY = ["text", "per_freedom"];

/** Whether a slider can span these ends. */
export const isRange = (low, high) => [low, high, sliderStep(low, high)].every(Number.isFinite) && low < high;

/** Keys that a point mass can not have, and why. */
const NOT_OF_A_POINT = {
  a: "a point mass has no size",
  b: "a point mass has no size",
  inertia: "a point mass has no moment of inertia",
  theta: "a point mass has no rotation",
  vtheta: "a point mass has no rotation",
};

/** The groups of keys of the thesis's case; the stops and, in a narrow window, most groups start closed. */
export const caseGroups = (schema) =>
  GROUPS.map(([group, title]) => ({
    title,
    keys: schema.keys.filter((key) => key.group === group),
    open: group !== "stops" && (group === "forcing" || matchMedia("(min-width: 700px)").matches),
  }));

/** Why a key of the thesis's case is not available. */
export const notOfAPoint = (name, state) => (state.value("body") === "point" ? NOT_OF_A_POINT[name] : undefined);

export class Controls {
  /**
   * Builds `groups` of keys, each with its title and whether it starts open, into `root`.
   * `reasonUnavailable(name, state)` returns why a key is not available. `onChange({ since, settled, gesture })` is
   * called after a change of a value; settled: not being dragged; gesture: a number that stays the same while one field
   * is edited.
   */
  constructor(root, state, { groups, reasonUnavailable, onChange }) {
    this.root = root;
    this.state = state;
    this.reasonUnavailable = reasonUnavailable;
    this.onChange = onChange;
    this.rows = new Map();
    this.latest = null;
    this.typing = null;
    this.gesture = 0;
    for (const begin of ["focusin", "pointerdown"]) root.addEventListener(begin, () => (this.gesture += 1), true);
    for (const group of groups) if (group.keys.length) root.append(this.#group(group));
    this.show();
  }

  #group({ title, keys, open, more = [], water = null }) {
    const details = element("details", { className: "group", open });
    if (water) details.dataset.water = water;
    details.append(element("summary", { textContent: title }), ...more);
    for (const key of keys) details.append(this.#row(key));
    return details;
  }

  #row(key) {
    const row = element("div", { className: "key" });
    const parts = { row, key };
    if (key.kind.type === "flag") this.#flag(parts);
    else if (key.kind.type === "choice") this.#choice(parts);
    else this.#numeric(parts);
    parts.error = element("p", { className: "key-error", id: `error-${key.name}`, hidden: true });
    parts.why = element("p", { className: "key-why", id: `why-${key.name}`, hidden: true });
    parts.field.setAttribute("aria-describedby", `meaning-${key.name} why-${key.name} error-${key.name}`);
    row.append(parts.why, parts.error);
    this.rows.set(key.name, parts);
    return row;
  }

  #label(key) {
    const label = element("label", { className: "key-label", htmlFor: `field-${key.name}` });
    const unit = unitText(key.unit);
    const wordy = symbolHtml(key.symbol) === key.symbol;
    const name = element("span", { className: wordy ? "symbol wordy" : "symbol" });
    if (wordy) name.textContent = key.symbol.replaceAll("_", " ");
    else name.innerHTML = symbolHtml(key.symbol);
    const meaning = element("span", { className: "meaning", id: `meaning-${key.name}` });
    meaning.textContent = withSymbols(["choice", "flag", ...ROOMY].includes(key.kind.type) ? key.meaning : key.title);
    label.title = withSymbols(key.meaning) + (key.default_in_words ? `. Default: ${withSymbols(key.default_in_words)}` : "");
    label.append(name, meaning);
    // Beside a field the heading of its group says of what it is.
    if (key.of) label.append(element("span", { className: "unseen", textContent: `, ${key.of}` }));
    if (unit) meaning.append(element("span", { className: "unit", textContent: ` [${unit}]` }));
    return label;
  }

  #numeric(parts) {
    const { key, row } = parts;
    const field = element("input", { type: "text", inputMode: "decimal", id: `field-${key.name}`, className: "field" });
    field.autocomplete = "off";
    field.spellcheck = false;
    const reset = element("button", {
      type: "button",
      className: "reset",
      textContent: "↺",
      title: "Back to the default",
    });
    reset.setAttribute("aria-label", `${key.name}: back to the default`);
    if (ROOMY.includes(key.kind.type)) row.classList.add("key-wide");
    row.append(this.#label(key), reset, field);
    Object.assign(parts, { field, reset });
    if (key.usual && isRange(key.usual.low, key.usual.high)) row.append(this.#ranged(parts, this.#slider(parts)));
    field.addEventListener("input", (event) => {
      // During typing only numbers are applied; other text is applied at the end.
      this.typing = key.name;
      if (readValue(key, field.value) !== undefined) this.#setText(parts, field.value, event, true);
    });
    field.addEventListener("change", (event) => {
      this.typing = null;
      this.#setText(parts, field.value, event, true);
      this.gesture += 1;
    });
    field.addEventListener("keydown", (event) => this.#stepField(parts, event));
    reset.addEventListener("click", (event) => {
      this.#setValue(parts, null, event, true);
      this.show();
      field.focus();
    });
  }

  #slider(parts) {
    const { key } = parts;
    const { low, high } = key.usual;
    const slider = element("input", { type: "range", className: "slider", id: `slider-${key.name}` });
    Object.assign(slider, { min: low, max: high, step: sliderStep(low, high) });
    slider.setAttribute("aria-label", `${key.name}: ${withSymbols(key.meaning)}`);
    slider.addEventListener("input", (event) => {
      parts.field.value = slider.value;
      this.#setValue(parts, Number(slider.value), event, false);
    });
    slider.addEventListener("change", (event) => this.#setValue(parts, Number(slider.value), event, true));
    this.#keepFromSwipes(parts, slider);
    parts.slider = slider;
    return slider;
  }

  /** A slider between two ends; the field also accepts values outside them. */
  #ranged(parts, slider) {
    const { key } = parts;
    const ends = ["low", "high"].map((name) => {
      const end = element("input", { type: "text", inputMode: "decimal", className: `end ${name}`, tabIndex: -1 });
      end.setAttribute("aria-label", `${key.name}: ${name} end of the slider`);
      end.title = "End of the slider; it can be edited";
      return end;
    });
    const show = () => [ends[0].value, ends[1].value] = [endText(Number(slider.min)), endText(Number(slider.max))];
    const setEnds = () => {
      const [low, high] = ends.map((end) => readValue(key, end.value));
      const { low: least, high: most } = key.kind;
      if (low < high && low >= least && high <= most) {
        const { value } = slider;
        Object.assign(slider, { min: low, max: high, step: sliderStep(low, high) });
        slider.value = this.state.value(key.name) ?? value;
      }
      show();
    };
    for (const end of ends) end.addEventListener("change", setEnds);
    show();
    const ranged = element("div", { className: "ranged" });
    ranged.append(ends[0], slider, ends[1]);
    parts.ranged = ranged;
    return ranged;
  }

  /** A touch that starts on a slider and then scrolls the page does not change the value. */
  #keepFromSwipes(parts, slider) {
    let before = null;
    slider.addEventListener("pointerdown", () => (before = this.state.values[parts.key.name] ?? null));
    slider.addEventListener("pointercancel", (event) => {
      this.#setValue(parts, before, event, true);
      this.show();
    });
  }

  #stepField(parts, event) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const value = Number(parts.field.value);
    if (!direction || !parts.slider || !Number.isFinite(value)) return;
    event.preventDefault();
    const step = sliderStep(parts.key.usual.low, parts.key.usual.high) * (event.shiftKey ? 10 : 1);
    parts.field.value = String(Number((value + direction * step).toPrecision(12)));
    this.#setText(parts, parts.field.value, event, true);
  }

  #flag(parts) {
    const { key, row } = parts;
    const field = element("input", { type: "checkbox", id: `field-${key.name}`, className: "tick" });
    row.classList.add("key-flag");
    row.append(field, this.#label(key));
    field.addEventListener("change", (event) => this.#setValue(parts, field.checked, event, true));
    parts.field = field;
  }

  #choice(parts) {
    const { key, row } = parts;
    const field = element("select", { id: `field-${key.name}`, className: "choice" });
    if (key.default === null) field.append(element("option", { value: "", textContent: "–" }));
    for (const option of key.kind.options) field.append(element("option", { value: option, textContent: option }));
    if (key.kind.options.some((option) => option.length > LONG_OPTION)) row.classList.add("key-wide");
    row.append(this.#label(key), field);
    field.addEventListener("change", (event) => this.#setValue(parts, field.value || null, event, true));
    parts.field = field;
  }

  /** The content of a field: a number, nothing (the default), or text that the server will refuse. */
  #setText(parts, text, event, settled) {
    const value = text.trim() === "" ? null : (readValue(parts.key, text) ?? text.trim());
    this.#setValue(parts, value, event, settled);
  }

  #setValue(parts, value, event, settled) {
    this.latest = parts.key.name;
    this.state.setValues({ [parts.key.name]: value });
    this.onChange({ since: event.timeStamp, settled, gesture: this.gesture });
  }

  /** Ends what is being typed, so that the values of the state take its place. */
  endTyping() {
    this.typing = null;
  }

  /** Shows the values of the state; text that is being typed stays. `effective` has the derived values. */
  show(effective = {}) {
    for (const [name, { key, field, slider, ranged, reset, why }] of this.rows) {
      // If a default depends on other keys, its value is known from the run.
      const given = this.state.values[name];
      const follows = given === undefined && key.default_in_words !== "" && effective[name] !== undefined;
      const value = follows ? effective[name] : this.state.value(name);
      const text = follows ? rounded(value) : fieldText(value);
      if (key.kind.type === "flag") setProperties(field, { checked: value });
      else if (this.typing !== name) setProperties(field, { value: text });
      if (reset) setProperties(reset, { hidden: !(name in this.state.values) });
      // A slider has one value; three numbers have none that it could show.
      if (ranged) setProperties(ranged, { hidden: text.startsWith("[") });
      if (slider) setProperties(slider, { value: String(value ?? slider.min) });
      if (slider) setAttributes(slider, { "aria-valuetext": `${text} ${unitText(key.unit)}`.trim() });
      // An unavailable key that is given is refused by the server; its field stays enabled so that it can be corrected.
      const reason = given === undefined ? this.reasonUnavailable(name, this.state) : undefined;
      // The default of a key that does not apply would be of no use, and take room.
      // Only keys of structures can stand for several things.
      const empty = this.state.differs?.(name) ? "they differ" : key.default_in_words;
      const placeholder = value === null && reason === undefined ? empty : "";
      setProperties(field, { disabled: reason !== undefined, placeholder });
      if (slider) setProperties(slider, { disabled: field.disabled });
      setProperties(why, { textContent: reason ?? "", hidden: !reason });
    }
  }

  /** Shows an error at the field of its key, or at the field that was changed last. */
  showError({ key, message }) {
    this.clearError();
    const parts = this.rows.get(key) ?? this.rows.get(this.latest);
    if (!parts) return;
    parts.error.textContent = message;
    parts.error.hidden = false;
    parts.field.setAttribute("aria-invalid", "true");
    const group = parts.row.closest("details");
    if (group) group.open = true;
  }

  clearError() {
    for (const { error, field } of this.rows.values()) {
      setProperties(error, { hidden: true });
      setAttributes(field, { "aria-invalid": null });
    }
  }
}

/** A computed number, without needless digits. */
function rounded(value) {
  if (typeof value !== "number") return fieldText(value);
  const [mantissa, exponent] = value.toExponential(2).split("e");
  return Math.abs(value) < 1e6 ? fieldText(Number(value.toPrecision(6))) : `${Number(mantissa)}e${Number(exponent)}`;
}

/** An end of a slider, with an exponent where the narrow field would not show all of it. */
function endText(value) {
  const text = fieldText(value);
  const short = value.toExponential().replace("e+", "e");
  return text.length > LONGEST_END && short.length < text.length ? short : text;
}

/** A round step, such that the range has some hundreds of them. */
function sliderStep(low, high) {
  const rough = (high - low) / 300;
  const power = 10 ** Math.floor(Math.log10(rough));
  return Number(([1, 2, 5, 10].find((m) => m * power >= rough * 0.6) * power).toPrecision(3));
}

function element(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}
