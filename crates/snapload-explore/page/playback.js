// Time: play, pause, step, scrub.

import { SPEEDS } from "./state.js";

export class Playback {
  /**
   * `currentRun` returns the run that is shown; `intoInterval` shows another interval if a time of the record is
   * outside the one that can be shown, and returns the time within it.
   */
  constructor(state, currentRun, intoInterval = (t) => t) {
    this.state = state;
    this.currentRun = currentRun;
    this.intoInterval = intoInterval;
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
    this.state.set({ t: this.intoInterval(Math.min(Math.max(t, 0), this.run.tEnd)) });
  }

  next() {
    if (!this.run) return;
    this.pause();
    this.seek(this.run.nextStop(this.state.t));
  }

  previous() {
    if (!this.run) return;
    this.pause();
    this.seek(this.run.previousStop(this.state.t));
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
    return this.run.interval(this.state.window)[0];
  }

  get #last() {
    return Math.min(this.run.interval(this.state.window)[1], this.run.tEnd);
  }
}
