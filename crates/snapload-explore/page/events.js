// The events as a table with the content of the charts; each row leads to its instant.

import { $ } from "./dom.js";
import { fixed, modeName, number } from "./formatting.js";

const ROWS = 50;
const WORDS = { start: "start", horizon: "horizon of trust", parts: "the ghost is 1e−3 away", end: "end" };

export class EventTable {
  constructor({ onJump }) {
    this.onJump = onJump;
    this.run = null;
    this.page = 0;
    this.at = null;
    /** Whether it belongs to an earlier run than the picture: pale, and its rows can not be selected. */
    this.old = false;
    this.body = $("events-body");
    $("events-previous").addEventListener("click", () => this.#turn(-1));
    $("events-next").addEventListener("click", () => this.#turn(1));
    this.body.addEventListener("keydown", (event) => this.#step(event));
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row && !this.old) onJump(this.run.events[Number(row.dataset.event)].t);
    });
  }

  setRun(run) {
    this.run = run;
    this.at = null;
    this.page = Math.min(this.page, this.#pages - 1);
    this.#fill();
  }

  setOld(old) {
    if (old === this.old) return;
    this.old = old;
    this.body.classList.toggle("stale", old);
  }

  get #pages() {
    return Math.max(1, Math.ceil(this.run.events.length / ROWS));
  }

  #turn(by) {
    if (!this.run) return;
    this.page = Math.min(Math.max(this.page + by, 0), this.#pages - 1);
    this.#fill();
    this.#mark();
    // The focus stays here at the first and the last page, where the button that was pressed is disabled.
    const [earlier, later] = ["events-previous", "events-next"].map($);
    if (earlier.disabled) later.focus();
    if (later.disabled) earlier.focus();
  }

  /** One row is in the tab order; the arrow keys move from row to row. */
  #step(event) {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const row = event.target.closest("tr");
    if (!by || !row) return;
    event.preventDefault();
    const next = by > 0 ? row.nextElementSibling : row.previousElementSibling;
    next?.querySelector(".go").focus();
  }

  /** Marks the row of the latest event at time t, and shows its page of the table if that is to follow. */
  show(t, follow) {
    if (!this.run) return;
    const at = this.run.eventAt(t);
    if (at === this.at) return;
    this.at = at;
    const page = Math.floor(at / ROWS);
    if (follow && page !== this.page) {
      this.page = page;
      this.#fill();
    }
    this.#mark();
  }

  #mark() {
    const onPage = Math.floor(this.at / ROWS) === this.page;
    for (const row of this.body.rows) {
      const here = Number(row.dataset.event) === this.at;
      row.querySelector(".go").tabIndex = here || (!onPage && row === this.body.rows[0]) ? 0 : -1;
      if (here) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
      if (here) this.#bringIntoSight(row);
    }
  }

  /** Reading a row's position forces a layout, so that it waits for a frame of its own. */
  #bringIntoSight(row) {
    requestAnimationFrame(() => {
      const box = this.body.closest(".scroll");
      const [top, bottom] = [row.offsetTop, row.offsetTop + row.offsetHeight];
      if (top < box.scrollTop || bottom > box.scrollTop + box.clientHeight) {
        box.scrollTop = top - box.clientHeight / 2;
      }
    });
  }

  #fill() {
    const { events } = this.run;
    const first = this.page * ROWS;
    this.body.innerHTML = events
      .slice(first, first + ROWS)
      .map((event, k) => this.#row(event, first + k))
      .join("");
    $("events-words").value = `events ${first + 1} to ${Math.min(first + ROWS, events.length)} of ${events.length}`;
    $("events-previous").disabled = this.page === 0;
    $("events-next").disabled = this.page === this.#pages - 1;
  }

  #row(event, index) {
    const { what, cable = "", figures = ["", "", "", ""] } = this.#describe(event);
    const shown = fixed(event.t, 6);
    const time = `<button type="button" class="go" data-t="${event.t}" aria-label="${shown}, go to ${what}">${shown}</button>`;
    const numbers = figures.map((figure) => `<td class="num">${figure}</td>`).join("");
    return `<tr data-event="${index}"><td>${time}</td><td>${what}</td><td>${cable}</td>${numbers}</tr>`;
  }

  #describe({ kind, impact: i, taut }) {
    if (kind === "mode") return { what: modeWords(taut) };
    if (kind !== "impact") return { what: WORDS[kind] };
    const { cable, v_n, impulse, energy_lost, digits } = this.run.impacts;
    return {
      what: impactWords(v_n[i], i),
      cable: `<span class="c${cable[i]}">${cable[i] === 1 ? "×" : "○"} ${cable[i]}</span>`,
      figures: [number(v_n[i], 5), number(impulse[i], 5), number(energy_lost[i], 4), digitsKnown(digits[i])],
    };
  }
}

/** A description of the events at exactly t; empty at any other time and at the start. */
export function eventWords(run, t) {
  const words = ({ kind, impact: i, taut }) => {
    if (kind === "mode") return taut.length ? `${modeName(taut)} begins` : "slack again";
    if (kind !== "impact") return WORDS[kind];
    const { cable, v_n } = run.impacts;
    return `${v_n[i] > 0 ? "snap of" : "impulse passed on by"} cable ${cable[i]}`;
  };
  const now = run.events.slice(run.eventAt(t)).filter((event) => event.t === t && event.kind !== "start");
  return [...new Set(now.map(words))].join(", ");
}

/** An impact on a taut cable has no closing velocity. */
const impactWords = (v_n, i) => `${v_n > 0 ? "snap" : "impulse passed on"} ${i + 1}`;
const modeWords = (taut) => (taut.length ? `${modeName(taut)}, cable ${taut.join(" and ")} taut` : "slack");
const digitsKnown = (value) => (Number.isFinite(value) ? fixed(Math.max(0, value), 1) : "–");
