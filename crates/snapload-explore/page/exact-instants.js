// The motion at exactly the instants at which it is read: between its rows the page can only interpolate.

import { fetchLong } from "./api.js";

/** The time cursor rests if it has not moved for this long. */
const REST_MS = 120;

export class ExactInstants {
  /** `path` answers with the motion at one time; `onArrival` is called when there is one more to show. */
  constructor(path, { onArrival }) {
    this.path = path;
    this.onArrival = onArrival;
    this.of = this.wanted = "";
    /** The answers for one run, by time. @type {Map<number, any>} */
    this.known = new Map();
  }

  /** Gives a run what is known of it, and asks for the motion at t once the time cursor rests there. */
  follow(run, question, t) {
    const of = JSON.stringify(question);
    if (of !== this.of) this.known = new Map();
    this.of = of;
    run.instants = this.known;
    const { rough, taut } = run.at(t);
    const wanted = rough || taut === null ? `${t} ${of}` : "";
    if (wanted === this.wanted) return;
    this.wanted = wanted;
    clearTimeout(this.resting);
    this.asking?.abort();
    if (wanted) this.resting = setTimeout(() => this.#ask(question, t), REST_MS);
  }

  async #ask(question, t) {
    const asking = (this.asking = new AbortController());
    // What is not answered stays marked as approximate.
    const answer = await fetchLong(this.path, { ...question, t }, asking.signal).catch(() => null);
    if (!answer || asking.signal.aborted) return;
    this.known.set(t, answer);
    this.onArrival();
  }
}
