// Pinned answers for comparison: the differences and outcomes of each, as text.

import { $ } from "./dom.js";
import { changesText } from "./structure-key-groups.js";
import { fixed, number } from "./formatting.js";

const MOST_PINS = 5;

/** The outcome of an answer, in the order in which it is shown. */
function outcome(run) {
  const known = run.lines.map(({ utilisation }) => utilisation);
  const largest = known.includes(null) ? null : Math.max(...known);
  const judged = run.lines.some(({ snaps }) => snaps !== null);
  const fastest = Math.max(0, ...run.lines.map((line) => line.fastest_snap_m_s));
  const slack = Math.max(...run.lines.map((line) => line.slack_fraction));
  return { standing: run.standing, judged, largest, fastest, slack };
}

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
    const { values, water, waterNow } = this.state;
    this.kept.push({ values: { ...values }, water, waterNow, outcome: outcome(run), preview: run.preview });
    this.show();
  }

  show() {
    $("pin").disabled = this.kept.length >= MOST_PINS;
    const run = this.currentRun();
    const html = run ? this.kept.map((pin, i) => line(pin, i, outcome(run))).join("") : "";
    if ($("pins").innerHTML !== html) $("pins").innerHTML = html;
  }
}

function line({ values, water, waterNow, outcome: of, preview }, i, shown) {
  const waters = water === null ? "" : `water: ${waterNow}`;
  const what = [waters, changesText(values)].filter(Boolean).join(", ") || "the case, unchanged";
  const compared = of.largest === null ? ["fastest", 2] : ["largest", 2];
  const [name, digits] = compared;
  const difference = shown[name] === null ? 0 : of[name] - shown[name];
  const far = fixed(Math.abs(difference), digits);
  const more = Number(far) === 0 ? "the same as now" : `${far} ${difference > 0 ? "more" : "less"} than now`;
  const much = of.largest === null ? `fastest snap ${fixed(of.fastest, 2)} m/s` : `utilisation ${fixed(of.largest, 2)}`;
  const first = preview ? ", first minutes only" : "";
  const comes = of.judged
    ? `${much} (${more}), fastest snap ${number(of.fastest, 3)} m/s, slack at most ${fixed(100 * of.slack, 1)} % of the time`
    : "nothing judged";
  return (
    `<li><button type="button" class="back" data-pin="${i}" title="Show this again">${what}</button>: <b>${of.standing}</b>` +
    `${first}, ${comes} ` +
    `<button type="button" class="unpin" data-pin="${i}" aria-label="Unpin ${what}">×</button></li>`
  );
}
