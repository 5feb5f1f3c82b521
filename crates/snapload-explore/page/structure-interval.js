// The interval of a structure's record that is shown, and steps out of it. Another one that was chosen counts from then
// on, while its answer is on its way.

import { fetchLong } from "./api.js";
import { note } from "./page.js";

export class StructureInterval {
  constructor(state, currentRun) {
    this.state = state;
    this.currentRun = currentRun;
  }

  /** Moves it to a time of the record that is outside it; returns the time within it. */
  into(t) {
    const { state } = this;
    const [from, to] = this.currentRun().intervalToCome(state.window);
    if (t >= from && t <= to) return t;
    this.moveTo(t - (to - from) / 2);
    return Math.min(Math.max(t, state.window[0]), state.window[1]);
  }

  /** Shows an interval of the same length with another start. */
  moveTo(begin) {
    const { state } = this;
    const run = this.currentRun();
    const [from, to] = run.intervalToCome(state.window);
    const length = to - from;
    const start = Math.min(Math.max(begin, 0), Math.max(run.tEnd - length, 0));
    const window = [start, start + length].map((time) => Number(time.toFixed(3)));
    state.set({ window, t: Math.min(Math.max(state.t, window[0]), window[1]) });
  }

  /** Goes back to the interval of the picture if another one could not be run. */
  stay() {
    const { state } = this;
    const run = this.currentRun();
    if (state.window && !run.isBeyond(state.window[1])) state.set({ window: run.window, t: run.nearest(state.t) });
  }

  /** The stop after or before a time, of which the page does not have all; null if there is no answer. */
  async unlistedStop(way, t) {
    const run = this.currentRun();
    const question = { case: run.ofCase, whole: !run.preview, t };
    try {
      const { previous, next } = await fetchLong("api/structure/instant", question);
      return way === "nextStop" ? (next ?? run.tEnd) : (previous ?? 0);
    } catch (error) {
      note(error.message);
      return null;
    }
  }
}
