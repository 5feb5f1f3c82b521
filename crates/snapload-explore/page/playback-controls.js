// The playback buttons, the strip of events, the clock, and the time window of the charts.

import { $, setAttributes, setProperties } from "./dom.js";
import { NEAR_PX, prepare } from "./plot.js";
import { SPEEDS } from "./state.js";
import { colours } from "./theme.js";
import { fixed, modeName, number } from "./formatting.js";

export class PlaybackControls {
  /** `speedWords` returns the text of a speed. */
  constructor(state, playback, speedWords = (speed) => `${speed} T/s`) {
    this.state = state;
    this.playback = playback;
    this.run = null;
    for (const speed of SPEEDS) $("speed").append(new Option(speedWords(speed), String(speed)));
    const on = (id, action) => $(id).addEventListener("click", () => this.run && action());
    on("play", () => playback.toggle());
    on("first", () => this.jump(this.ends[0]));
    on("last", () => this.jump(this.ends[1]));
    on("previous", () => playback.previous());
    on("next", () => playback.next());
    on("zoom-in", () => this.zoom(0.5));
    on("zoom-out", () => this.zoom(2));
    on("zoom-all", () => state.set({ window: null }));
    $("speed").addEventListener("change", () => state.set({ speed: Number($("speed").value) }));
    $("loop").addEventListener("change", () => state.set({ loop: $("loop").checked }));
    $("scrub").addEventListener("input", () => {
      playback.pause();
      playback.seek(Number($("scrub").value));
    });
  }

  /** The first and the last time of the slider. */
  get ends() {
    return [0, this.run.tEnd];
  }

  /** The time window that shows all. */
  get all() {
    return null;
  }

  jump(t) {
    this.playback.pause();
    this.playback.seek(t);
  }

  /** Multiplies the length of the time window about the cursor. */
  zoom(factor) {
    const end = this.run.tEnd;
    const [from, to] = this.run.intervalToCome(this.state.window);
    const length = (to - from) * factor;
    if (length >= end) return this.state.set({ window: this.all });
    const least = Math.max(length, 1e-6);
    const start = Math.min(Math.max(this.state.t - least / 2, 0), end - least);
    this.state.set({ window: [Number(start.toPrecision(9)), Number((start + least).toPrecision(9))] });
  }

  setRun(run) {
    this.run = run;
  }

  showPlaying(playing) {
    $("play").textContent = playing ? "Pause" : "Play";
    this.show();
  }

  show() {
    if (!this.run) return;
    const { speed, window } = this.state;
    const t = this.run.nearest(this.state.t);
    const [from, to] = this.run.interval(window);
    setProperties($("scrub"), { min: String(from), max: String(to) });
    setProperties($("scrub"), { value: String(t) });
    const words = this.words(t, this.run);
    if (!this.playback.playing) setAttributes($("scrub"), { "aria-valuetext": words.value });
    setAttributes($("clock"), { "data-t": String(t) });
    setProperties($("clock"), { value: words.clock });
    setProperties($("counted"), { textContent: words.counted });
    setProperties($("speed"), { value: String(speed) });
    setProperties($("loop"), { checked: this.state.loop });
    setProperties($("window-words"), { value: window ? `t ${number(from, 4)} to ${number(to, 4)}` : "" });
    setProperties($("zoom-all"), { disabled: window === null });
  }

  /** The time as spoken and shown text, and the number of events before it. */
  words(t, run) {
    return {
      value: `${fixed(t, 3)} of ${fixed(run.tEnd, 3)} T, ${modeName(run.tautAt(t))}`,
      clock: `t = ${fixed(t, 4)} T`,
      counted: `${run.listed(t) ? "" : "past "}impact ${run.snapsUntil(t)} of ${run.snaps}`,
    };
  }

  /**
   * The strip behind the slider: taut cables as bands, two higher than one, impacts as ticks, and grey what is past the
   * horizon.
   */
  draw() {
    const { context, width, height } = prepare($("strip"));
    const paints = colours();
    const [from, to] = this.state.window ?? [0, this.run.tEnd || 1];
    const inset = 8;
    const x = (t) => inset + ((t - from) / (to - from)) * (width - 2 * inset);
    const band = (a, b, colour, y, h) => {
      const [left, right] = [Math.max(x(a), inset), Math.min(x(b), width - inset)];
      if (right <= left) return;
      context.fillStyle = colour;
      context.fillRect(left, y, Math.max(right - left, 1), h);
    };
    const { modes, horizon, impacts } = this.run;
    if (horizon.t !== null) band(horizon.t, this.run.tEnd, paints.shade, 0, height);
    modes.taut.forEach((taut, i) => {
      const high = 2.5 * Math.min(taut.length, 2);
      if (high) band(modes.t_start[i], modes.t_end[i], paints.strained, height - high, high);
    });
    // An accumulation has thousands of snaps in one place: the highest so far hides the others.
    const highest = new Map();
    impacts.t.forEach((t, i) => {
      if (t < from || t > to) return;
      const part = Math.sqrt(impacts.impulse[i] / (this.run.hardest || 1));
      const place = `${impacts.cable[i]} ${Math.round(x(t) / NEAR_PX)}`;
      if (part <= (highest.get(place) ?? -1)) return;
      highest.set(place, part);
      context.fillStyle = paints[`cable-${impacts.cable[i]}`];
      context.fillRect(x(t) - 0.6, height - 5 - (height - 6) * part, 1.2, (height - 6) * part);
    });
  }
}
