// Pinned answers for comparison: the differences and outcomes of each, as text.

import { $, replaceButtons } from "./dom.js";
import { changesText } from "./structure-key-groups.js";
import { escape, fixed, number, ratio } from "./formatting.js";

const MOST_PINS = 5;
/** What may still change an answer, by how far it is computed. */
const STAGES = [", first minutes only", ", without neighbours", ""];
const stage = (run) => (run.preview ? 0 : run.hasOtherRuns ? 2 : 1);

/** The outcome of an answer, in the order in which it is shown. */
function outcome(run) {
  const known = run.lines.map(({ utilisation }) => utilisation);
  const largest = known.includes(null) ? null : Math.max(...known);
  const judged = run.lines.some(({ snaps }) => snaps !== null);
  const fastest = Math.max(0, ...run.lines.map((line) => line.fastest_snap_m_s));
  const slack = Math.max(...run.lines.map((line) => line.slack_fraction));
  return { standing: run.standing, judged, largest, fastest, slack };
}

/** What a pin keeps of an answer. */
const kept = (run) => ({ of: JSON.stringify(run.ofCase), stage: stage(run), outcome: outcome(run) });

export class PinnedAnswers {
  /** `currentRun` returns the run that is shown; `onBack` receives a pin that is to be shown again. */
  constructor(state, currentRun, { onBack }) {
    this.state = state;
    this.currentRun = currentRun;
    this.kept = [];
    $("pin").addEventListener("click", () => this.add());
    $("pins").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (!button) return;
      const at = Number(button.dataset.pin);
      if (button.className !== "unpin") return onBack(this.kept[at]);
      this.kept.splice(at, 1);
      this.show();
    });
  }

  add() {
    const run = this.currentRun();
    if (!run || this.kept.length >= MOST_PINS) return;
    // The values of the run; those of the fields may be refused, or on their way.
    const { set, water } = run.ofCase;
    const values = this.state.valuesOf(set);
    this.kept.push({ values, water, ...kept(run) });
    this.show();
  }

  show() {
    $("pin").disabled = this.kept.length >= MOST_PINS;
    const run = this.currentRun();
    if (run) this.#complete(kept(run));
    const html = run ? this.kept.map((pin, i) => line(pin, i, outcome(run))).join("") : "";
    replaceButtons($("pins"), html, $("pin"));
  }

  /** Gives the pins of a case what was computed of it since. */
  #complete(now) {
    for (const pin of this.kept) if (pin.of === now.of && pin.stage < now.stage) Object.assign(pin, now);
  }
}

const speed = (value) => fixed(value, 2);

/** How much more or less a number is than the one shown now, in as many decimals as `written` gives either. */
function compared(value, now, written) {
  if (now === null) return "not known now";
  const decimals = [value, now].map((one) => written(one).split(".")[1].length);
  const far = fixed(Math.abs(value - now), Math.max(...decimals));
  return Number(far) === 0 ? "the same as now" : `${far} ${value > now ? "more" : "less"} than now`;
}

function line({ values, water, outcome: of, stage: reached }, i, shown) {
  const waters = water === null ? "" : `water: ${water}`;
  const what = escape([waters, changesText(values)].filter(Boolean).join(", ")) || "the case, unchanged";
  const more = of.largest === null ? compared(of.fastest, shown.fastest, speed) : compared(of.largest, shown.largest, ratio);
  const much = of.largest === null ? `fastest snap ${speed(of.fastest)} m/s` : `utilisation ${ratio(of.largest)}`;
  const comes = of.judged
    ? `${much} (${more}), fastest snap ${number(of.fastest, 3)} m/s, slack at most ${fixed(100 * of.slack, 1)} % of the whole time`
    : "nothing judged";
  return (
    `<li><button type="button" class="back" data-pin="${i}" title="Show this again">${what}</button>: <b>${of.standing}</b>` +
    `${STAGES[reached]}, ${comes} ` +
    `<button type="button" class="unpin" data-pin="${i}" aria-label="Unpin ${what}">×</button></li>`
  );
}
