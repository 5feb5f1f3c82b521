// The fields of an axis of a map: a key, from where to where, in how many cells.

import { $ } from "./dom.js";
import { MOST_CELLS, readValue } from "./state.js";
import { plain } from "./words.js";

const ENDS = ["low", "high", "count"];

export class AxisFields {
  /**
   * The fields have ids that begin with `id`, such as `map-x-key`. `value(name)` is that of a key, `now()` the axis as it
   * is; `onChange` is told of another axis, `onWrong` in words of what can be none, or that all is well again.
   */
  constructor(id, keys, { value, now, onChange, onWrong }) {
    this.id = id;
    this.now = now;
    const key = this.#field("key");
    for (const one of keys) key.append(new Option(one.name, one.name));
    key.addEventListener("change", () => {
      const { usual } = keys.find((one) => one.name === key.value);
      const about = value(key.value) ?? 1;
      const range = usual ?? { low: about * 0.5, high: about * 2 || 1 };
      onChange({ ...now(), key: key.value, ...range });
    });
    for (const name of ENDS) {
      const field = this.#field(name);
      field.addEventListener("change", () => {
        const axis = { ...now(), [name]: readValue({ kind: { type: "number" } }, field.value) };
        const legal = isAxis(axis);
        field.setAttribute("aria-invalid", String(!legal));
        const side = id.split("-").at(-1);
        onWrong(legal ? "" : `${side}: from a lower to a higher value, in 2 to ${MOST_CELLS} cells`);
        if (legal) onChange(axis);
      });
    }
  }

  #field(name) {
    return $(`${this.id}-${name}`);
  }

  /** Shows the axis as it is; what is being typed stays. */
  show() {
    for (const name of ["key", ...ENDS]) {
      const field = this.#field(name);
      if (document.activeElement !== field || name === "key") field.value = plain(this.now()[name]);
    }
  }
}

/** Whether there are cells from one end to the other. */
const isAxis = ({ low, high, count }) =>
  high > low && Number.isInteger(count) && count >= 2 && count <= MOST_CELLS;

/** The same axes with another one of a side; a key that one of the others had changes places with it. */
export function withAxis(axes, side, axis) {
  const other = ["x", "y", "over"].find((one) => one !== side && axes[one]?.key === axis.key);
  return { ...axes, [side]: axis, ...(other ? { [other]: axes[side] } : {}) };
}

/** The usual range of a key in so many cells. */
export function usualAxis(keys, name, count) {
  const { low, high } = keys.find((key) => key.name === name).usual;
  return { key: name, low, high, count };
}
