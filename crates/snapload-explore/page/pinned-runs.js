// Pinned runs for comparison: drawn beneath the current run, with their differences as text.

import { fetchRun } from "./api.js";
import { $, replaceButtons } from "./dom.js";
import { Run } from "./run.js";
import { MOST_PINS } from "./state.js";
import { number, fieldText, reasonText } from "./formatting.js";

const SAMPLES = 1200;
/** Wong's colours for colour-blind readers (Nature Methods 8 (2011) 441), without those of cables and modes. */
const COLOURS = ["#009e73", "#cc79a7", "#7a6a00"];

export class PinnedRuns {
  /** `current` returns the run that is shown and its values; `onChange` is called when there is something else to draw. */
  constructor(state, current, { onChange }) {
    this.state = state;
    this.current = current;
    this.onChange = onChange;
    /** The pins in their order; those without a run can not be computed. @type {any[]} */
    this.all = [];
    this.asked = "";
    $("pin").addEventListener("click", () => this.add());
    $("pins").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (!button) return;
      const at = Number(button.dataset.pin);
      const { values } = this.all[at];
      if (button.className === "unpin") state.set({ pins: state.pins.filter((_, i) => i !== at) });
      else state.set({ values: { ...values } });
    });
  }

  /** The pinned runs that are drawn. */
  get kept() {
    return this.all.filter(({ run }) => run !== null);
  }

  /** Pins the run that is shown; the values of the fields may be refused, or on their way. */
  add() {
    const { run, values } = this.current();
    if (!run) return;
    const { pins } = this.state;
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
    this.all = pins.map((values, i) => ({ values, run: runs[i], colour: COLOURS[i] }));
    this.onChange();
  }

  /** The differences of each from the current run, and its outcome. */
  show() {
    const shown = this.current();
    $("pin").disabled = this.all.length >= MOST_PINS;
    const html = this.all.map((pin, i) => this.#line(pin, i, shown)).join("");
    replaceButtons($("pins"), html, $("pin"));
  }

  #line({ values, run, colour }, i, shown) {
    const keys = this.state.schema.keys.map((key) => key.name);
    const value = (of, name) => fieldText(of[name] ?? this.state.defaults[name]);
    const differ = keys.filter((name) => value(values, name) !== value(shown.values, name));
    const what = differ.map((name) => `${name} = ${value(values, name)}`).join(", ") || "the run that is shown";
    return (
      `<li><i class="swatch" style="background:${colour}"></i> <button type="button" class="back" data-pin="${i}" ` +
      `title="Show this run">${what}</button>: ${run ? compared(run, shown.run) : "can not be run"} ` +
      `<button type="button" class="unpin" data-pin="${i}" aria-label="Unpin ${what}">×</button></li>`
    );
  }
}

/** How a pinned run ends, and how hard it snaps, compared with the run that is shown. */
function compared(run, shown) {
  const [hardest, now] = [run, shown].map(({ norms }) => number(norms.rho1));
  const notes = hardest === now ? [] : [run.norms.rho1 > shown.norms.rho1 ? "harder" : "softer"];
  if ([run, shown].some(({ norms_known }) => norms_known.rho1 === "not certain")) notes.push("not certain");
  const more = notes.length ? ` (${notes.join(", ")})` : "";
  const sure = run.horizon.t === null ? "" : " (not certain)";
  return `${reasonText(run.end.reason)} at t = ${number(run.end.t)}${sure}, hardest snap ${hardest}${more}`;
}

/** A pinned run; null if it can not be computed, for example that of an old link. */
async function run(values) {
  try {
    return new Run(await fetchRun({ values, ghost: null, samples: SAMPLES }));
  } catch {
    return null;
  }
}
