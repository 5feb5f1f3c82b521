// Long motions: the section once a period of the forcing.

import { fetchSection } from "./api.js";
import { $ } from "./dom.js";
import { number, withSymbols } from "./formatting.js";

const STATE = ["x", "y", "theta", "vx", "vy", "vtheta"];
const SYMBOLS = { x: "x", y: "y", theta: "θ", vx: "ẋ", vy: "ẏ", vtheta: "θ̇" };
/** The size of the picture, and its margins. */
const [WIDTH, HEIGHT] = [520, 300];
const MARGIN = { left: 62, right: 12, top: 12, bottom: 40 };

/** One request at a time, started and cancelled by one button. */
export class CancellableRequest {
  constructor(button, message, ask) {
    this.button = $(button);
    this.message = $(message);
    this.words = this.button.textContent;
    this.ask = ask;
    this.button.addEventListener("click", () => (this.running ? this.stop() : this.#go()));
  }

  stop() {
    this.running?.abort();
    this.#end("");
  }

  #end(words) {
    this.running = null;
    this.button.textContent = this.words;
    this.message.textContent = words;
  }

  async #go() {
    const running = (this.running = new AbortController());
    this.button.textContent = "Stop";
    this.message.textContent = "Computing …";
    let words;
    try {
      words = await this.ask(running.signal);
    } catch (error) {
      words = error.message;
    }
    // A cancelled request has no message.
    if (this.running === running) this.#end(words);
  }
}

/** The text of the command with single spaces. */
export const lines = (words) => withSymbols(words.trim().replaceAll(/ {2,}/g, " "));

export class LongRun {
  /** @param {{ values: () => object, onPick: (start: object) => void }} page */
  constructor(page) {
    this.page = page;
    this.points = [];
    for (const [id, chosen] of [
      ["section-across", "x"],
      ["section-up", "vx"],
    ]) {
      $(id).replaceChildren(...STATE.map((key) => new Option(SYMBOLS[key], key, key === chosen, key === chosen)));
      $(id).addEventListener("change", () => this.#draw());
    }
    this.section = new CancellableRequest("section-run", "section-message", async (signal) => {
      const answer = await fetchSection({ values: page.values() }, signal);
      if (signal.aborted) return "";
      this.points = answer.points.map(({ state }) => state);
      this.#draw();
      return lines(answer.words);
    });
  }

  /** Takes changed values: the results that are shown do not belong to them. */
  setValues(values) {
    const key = JSON.stringify(values);
    if (key === this.key) return;
    this.key = key;
    this.section.stop();
    this.points = [];
    this.#draw();
  }

  #draw() {
    const svg = $("section-plot");
    svg.toggleAttribute("hidden", this.points.length === 0);
    if (this.points.length === 0) return;
    const keys = [$("section-across").value, $("section-up").value];
    const [xs, ys] = keys.map((key) => this.points.map((state) => state[STATE.indexOf(key)]));
    const across = scale(xs, MARGIN.left, WIDTH - MARGIN.right);
    const up = scale(ys, HEIGHT - MARGIN.bottom, MARGIN.top);
    const parts = [frame(), ...across.marks.map(mark(true)), ...up.marks.map(mark(false))];
    parts.push(text(SYMBOLS[keys[0]], WIDTH / 2, HEIGHT - 6, "middle"), text(SYMBOLS[keys[1]], 12, 20, "middle"));
    this.points.forEach((state, k) => {
      const dot = element("circle", { cx: across.at(xs[k]), cy: up.at(ys[k]), r: 2.4, class: "point" });
      const start = Object.fromEntries(STATE.map((key, i) => [key, state[i]]));
      dot.addEventListener("click", () => this.page.onPick(start));
      parts.push(dot);
    });
    svg.replaceChildren(...parts);
    svg.setAttribute("aria-label", `Section: ${this.points.length} points, ${keys[1]} against ${keys[0]}`);
  }
}

function element(name, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}

function text(words, x, y, anchor) {
  const made = element("text", { x, y, "text-anchor": anchor });
  made.textContent = words;
  return made;
}

function frame() {
  const { left, right, top, bottom } = MARGIN;
  return element("rect", { x: left, y: top, width: WIDTH - left - right, height: HEIGHT - top - bottom, class: "frame" });
}

const mark = (isAcross) => (value) =>
  isAcross ? text(value.words, value.at, HEIGHT - 22, "middle") : text(value.words, MARGIN.left - 6, value.at + 4, "end");

/** A scale from values to positions, with labels near the ends and in the middle. */
function scale(values, from, to) {
  let [low, high] = [Math.min(...values), Math.max(...values)];
  // Equal points, such as those of an orbit of one period, are in the middle.
  const room = Math.max(0.06 * (high - low), 1e-3 * Math.max(Math.abs(low), Math.abs(high), 1e-3));
  [low, high] = [low - room, high + room];
  const at = (value) => from + ((value - low) / (high - low)) * (to - from);
  const marked = [0.1, 0.5, 0.9].map((part) => low + part * (high - low));
  return { at, marks: marked.map((value) => ({ at: at(value), words: number(value, 3) })) };
}
