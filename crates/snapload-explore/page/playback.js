// Time: play, pause, step, scrub.

import { SPEEDS } from "./state.js";

export class Playback {
  /**
   * `currentRun` returns the run that is shown. `interval.into` shows another interval if a time of the record is
   * outside the one that can be shown, and returns the time within it; `interval.unlistedStop` asks for a stop that the
   * run does not list.
   * @param {{ into: (t: number) => number, unlistedStop: (way: string, t: number) => Promise<number | null> }} interval
   */
  constructor(state, currentRun, interval = { into: (t) => t, unlistedStop: async () => null }) {
    this.state = state;
    this.currentRun = currentRun;
    this.interval = interval;
    /** The steps that wait for an answer. @type {Promise<void> | null} */
    this.steps = null;
    this.playing = false;
    this.frame = null;
    /** @type {(playing: boolean) => void} */
    this.onPlaying = () => {};
  }

  get run() {
    return this.currentRun();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (!this.run) return;
    const { t } = this.state;
    if (t < this.#first || t >= this.#last) this.state.set({ t: this.#first });
    this.playing = true;
    this.onPlaying(true);
    let before = null;
    const tick = (time) => {
      if (!this.playing) return;
      // After it was hidden, the page continues from the same time.
      const elapsed = before === null ? 0 : Math.min((time - before) / 1000, 0.1);
      before = time;
      const t = this.state.t + elapsed * this.state.speed;
      this.state.set({ t: Math.min(t, this.#last) });
      if (t >= this.#last) {
        if (!this.state.loop) return this.pause();
        this.state.set({ t: this.#first });
      }
      this.frame = requestAnimationFrame(tick);
    };
    this.frame = requestAnimationFrame(tick);
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    cancelAnimationFrame(this.frame);
    this.onPlaying(false);
  }

  seek(t) {
    if (!this.run) return;
    this.state.set({ t: this.interval.into(Math.min(Math.max(t, 0), this.run.tEnd)) });
  }

  next() {
    this.#step("nextStop");
  }

  previous() {
    this.#step("previousStop");
  }

  /** Goes to a stop. Steps after one that waits for an answer wait, too. */
  #step(way) {
    if (!this.run) return;
    this.pause();
    const stop = this.steps ? null : this.run[way](this.state.t);
    if (stop !== null) return this.seek(stop);
    const steps = (this.steps ?? Promise.resolve()).then(() => this.#stepLater(way));
    this.steps = steps;
    steps.then(() => {
      if (this.steps === steps) this.steps = null;
    });
  }

  async #stepLater(way) {
    const { t } = this.state;
    const ofCase = () => JSON.stringify(this.run.ofCase);
    const before = ofCase();
    const stop = this.run[way](t) ?? (await this.interval.unlistedStop(way, t));
    // Meanwhile the time cursor may have been moved by hand, or another case be shown.
    if (stop !== null && this.state.t === t && ofCase() === before) this.seek(stop);
  }

  /** A small step: 1/500 of the time that is shown. */
  fine(direction) {
    this.pause();
    this.seek(this.state.t + (direction * (this.#last - this.#first)) / 500);
  }

  faster(direction) {
    const i = SPEEDS.indexOf(this.state.speed) + direction;
    if (SPEEDS[i]) this.state.set({ speed: SPEEDS[i] });
  }

  get #first() {
    return this.run.intervalToCome(this.state.window)[0];
  }

  get #last() {
    return Math.min(this.run.intervalToCome(this.state.window)[1], this.run.tEnd);
  }
}
