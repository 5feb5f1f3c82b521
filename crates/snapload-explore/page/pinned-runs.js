// Pinned runs for comparison: drawn beneath the current run, with their differences as text.

import { fetchRun } from "./api.js";
import { $ } from "./dom.js";
import { Run } from "./run.js";
import { MOST_PINS } from "./state.js";
import { number, fieldText, reasonText } from "./formatting.js";

const SAMPLES = 1200;
/** Wong's colours for colour-blind readers (Nature Methods 8 (2011) 441), without those of cables and modes. */
const COLOURS = ["#009e73", "#cc79a7", "#7a6a00"];

export class PinnedRuns {
  /** `currentRun` returns the run that is shown; `onChange` is called when there is something else to draw. */
  constructor(state, currentRun, { onChange }) {
    this.state = state;
    this.currentRun = currentRun;
    this.onChange = onChange;
    this.kept = [];
    this.asked = "";
    $("pin").addEventListener("click", () => this.add());
    $("pins").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (!button) return;
      const at = Number(button.dataset.pin);
      const { values } = this.kept[at];
      if (button.className === "unpin") state.set({ pins: state.pins.filter((_, i) => i !== at) });
      else state.set({ values: { ...values } });
    });
  }

  add() {
    if (!this.currentRun()) return;
    const { pins, values } = this.state;
    this.state.set({ pins: [...pins, { ...values }].slice(-MOST_PINS) });
  }

  /** Follows the state: computes the pinned runs. */
  async follow() {
    const { pins } = this.state;
    const asked = JSON.stringify(pins);
    if (asked === this.asked) return;
    this.asked = asked;
    const known = new Map(this.kept.map((pin) => [JSON.stringify(pin.values), pin.run]));
    const runs = await Promise.all(pins.map((values) => known.get(JSON.stringify(values)) ?? run(values)));
    if (asked !== this.asked) return;
    this.kept = pins.map((values, i) => ({ values, run: runs[i], colour: COLOURS[i] })).filter((pin) => pin.run);
    this.onChange();
  }

  /** The differences of each from the current run, and its outcome. */
  show() {
    const run = this.currentRun();
    $("pin").disabled = this.kept.length >= MOST_PINS;
    const html = this.kept.map((pin, i) => this.#line(pin, i, run)).join("");
    if ($("pins").innerHTML !== html) $("pins").innerHTML = html;
  }

  #line({ values, run, colour }, i, shown) {
    const keys = this.state.schema.keys.map((key) => key.name);
    const value = (of, name) => fieldText(of[name] ?? this.state.defaults[name]);
    const differ = keys.filter((name) => value(values, name) !== value(this.state.values, name));
    const what = differ.map((name) => `${name} = ${value(values, name)}`).join(", ") || "the run that is shown";
    const more = (a, b, words) => (a === b ? "" : ` (${words[a > b ? 0 : 1]})`);
    const hardest = more(number(run.norms.rho1), number(shown.norms.rho1), ["harder", "softer"]);
    const sure = run.horizon.t === null ? "" : " (not certain)";
    const outcome = `${reasonText(run.end.reason)} at t = ${number(run.end.t)}${sure}, hardest snap ${number(run.norms.rho1)}`;
    return (
      `<li><i class="swatch" style="background:${colour}"></i> <button type="button" class="back" data-pin="${i}" ` +
      `title="Show this run">${what}</button>: ${outcome}${run.norms.rho1 === shown.norms.rho1 ? "" : hardest} ` +
      `<button type="button" class="unpin" data-pin="${i}" aria-label="Unpin ${what}">×</button></li>`
    );
  }
}

/** A pinned run that can not be computed, for example of an old link, is left out. */
async function run(values) {
  try {
    return new Run(await fetchRun({ values, ghost: null, samples: SAMPLES }));
  } catch {
    return null;
  }
}
