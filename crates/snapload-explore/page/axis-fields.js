// The fields of an axis of a map: its key, its range and its number of cells.

import { $, setAttributes } from "./dom.js";
import { MOST_CELLS, finite, isAxis, isCount, same } from "./state.js";
import { fieldText } from "./formatting.js";

const ENDS = ["low", "high", "count"];

export class AxisFields {
  /**
   * Builds the fields in the fieldset with the id `id`; their own ids begin with it, such as `map-x-key`. `legend` is
   * their heading, `counted` names what is counted along the axis. `value(name)` returns the value of a key,
   * `currentAxis()` the current axis; `onChange` receives a changed axis, `onInvalid` a message, empty if all is valid.
   */
  constructor(id, keys, { legend, counted = "cells", value, currentAxis, onChange, onInvalid }) {
    this.id = id;
    this.currentAxis = currentAxis;
    this.onInvalid = onInvalid;
    this.shown = null;
    this.invalid = false;
    const field = (name, words, mode) =>
      `<label>${words} <input type="text" inputmode="${mode}" class="field" id="${id}-${name}"></label>`;
    $(id).innerHTML =
      `<legend>${legend}</legend><select id="${id}-key" aria-label="Key, ${legend.toLowerCase()}"></select>` +
      field("low", "from", "decimal") + field("high", "to", "decimal") + field("count", counted, "numeric");
    const key = this.#field("key");
    for (const one of keys) key.append(new Option(one.name, one.name));
    key.addEventListener("change", () => {
      const { usual } = keys.find((one) => one.name === key.value);
      const own = value(key.value);
      const about = Number.isFinite(own) ? own : 1;
      const range = usual ?? { low: about * 0.5, high: about * 2 || 1 };
      onChange({ ...currentAxis(), key: key.value, ...range });
    });
    const words = `${legend}: "from" must be less than "to", with 2 to ${MOST_CELLS} ${counted}`;
    for (const name of ENDS) {
      this.#field(name).addEventListener("change", () => {
        const axis = this.#typed();
        this.#validate(axis, words);
        if (isAxis(axis)) onChange(axis);
      });
    }
  }

  #field(name) {
    return $(`${this.id}-${name}`);
  }

  /** The axis in the fields: a value that was refused may be allowed once another field has changed. */
  #typed() {
    return { ...this.currentAxis(), ...Object.fromEntries(ENDS.map((name) => [name, finite(this.#field(name).value)])) };
  }

  /** Marks invalid fields and reports them. */
  #validate(axis, words) {
    const { low, high, count } = axis;
    const crossed = high <= low;
    const invalid = { low: crossed || low === undefined, high: crossed || high === undefined, count: !isCount(count) };
    for (const name of ENDS) setAttributes(this.#field(name), { "aria-invalid": String(invalid[name]) });
    this.invalid = !isAxis(axis);
    this.onInvalid(this.invalid ? words : "");
  }

  /** Shows a changed axis; text that is being typed stays. */
  show() {
    const axis = this.currentAxis();
    if (same(axis, this.shown)) return;
    this.shown = axis;
    for (const name of ["key", ...ENDS]) {
      const field = this.#field(name);
      if (document.activeElement !== field || name === "key") field.value = fieldText(axis[name]);
      setAttributes(field, { "aria-invalid": null });
    }
    if (this.invalid) this.onInvalid("");
    this.invalid = false;
  }
}

/** The axes with one of them replaced; if another one has the same key, the two are exchanged. */
export function withAxis(axes, side, axis) {
  const other = ["x", "y", "over"].find((one) => one !== side && axes[one]?.key === axis.key);
  return { ...axes, [side]: axis, ...(other ? { [other]: axes[side] } : {}) };
}

/** The usual range of a key with a number of cells. */
export function usualAxis(keys, name, count) {
  const { low, high } = keys.find((key) => key.name === name).usual;
  return { key: name, low, high, count };
}
