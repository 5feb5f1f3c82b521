// Playback of a structure's run: a strip with the interval that is shown, and one with the whole record.

import { $ } from "./dom.js";
import { prepare } from "./plot.js";
import { tautWords } from "./structure-scene-view.js";
import { colours, lineColour } from "./theme.js";
import { PlaybackControls } from "./playback-controls.js";
import { speedWords } from "./structure-key-groups.js";
import { fixed, round } from "./formatting.js";

const INSET_PX = 8;
/** Of many snaps only the hardest within this many pixels is drawn. */
const APART_PX = 1.5;

export class StructurePlaybackControls extends PlaybackControls {
  /** `onInterval` receives the start of the interval that is to be shown. */
  constructor(state, playback, { onInterval }) {
    super(state, playback, speedWords);
    $("interval-start").addEventListener("input", () => {
      if (!this.run) return;
      playback.pause();
      onInterval(Number($("interval-start").value));
    });
  }

  /** Only the motion of the interval that is shown is available. */
  get ends() {
    return this.run.intervalToCome(this.state.window);
  }

  /** Without a time window the interval around the hardest snap is shown. */
  get all() {
    return [0, this.run.tEnd];
  }

  words(t, run) {
    return {
      value: `${fixed(t, 2)} of ${fixed(run.tEnd, 2)} s, ${tautWords(run, t)}`,
      clock: `t = ${fixed(t, 2)} s`,
      counted: run.snapsUntil(t),
    };
  }

  show() {
    super.show();
    if (!this.run) return;
    const { window } = this.run;
    // The slider stays where it is moved to.
    const [from, to] = this.run.intervalToCome(this.state.window);
    // Over the whole record, as it is drawn above it.
    const most = Math.max(this.run.lasts_s - (to - from), 0);
    // Before the whole record is run there is nothing to choose from.
    const { preview } = this.run;
    Object.assign($("interval-start"), { min: 0, max: most, value: from, disabled: most === 0 || preview });
    $("interval-start").setAttribute("aria-valuetext", `from ${round(from)} to ${round(to)} of ${round(this.run.tEnd)} s`);
    $("window-words").value = `${fixed(window[0], 1)} to ${fixed(window[1], 1)} s`;
    $("zoom-all").disabled = preview;
  }

  draw() {
    this.#strip($("strip"), this.run.window, true);
    this.#strip($("record"), [0, this.run.lasts_s], false);
    const { run } = this;
    const { listedUntil } = run;
    const drawn = listedUntil === null ? "" : `; after ${round(listedUntil)} s only the hardest and those of the interval are drawn`;
    const words = `${run.snapsInWords} in ${round(run.tEnd)} s${drawn}`;
    $("record-words").textContent = words;
    $("record").setAttribute("aria-label", `${words}; the height shows the strength`);
  }

  /** Snaps as ticks in the colours of their lines, taut lines as bands, and the interval within the record. */
  #strip(canvas, [from, to], close) {
    const { context, width, height } = prepare(canvas);
    const { run } = this;
    const paints = colours();
    const x = (t) => INSET_PX + ((t - from) / (to - from || 1)) * (width - 2 * INSET_PX);
    const band = (a, b, colour, y, h) => {
      const [left, right] = [Math.max(x(a), INSET_PX), Math.min(x(b), width - INSET_PX)];
      if (right <= left) return;
      context.fillStyle = colour;
      context.fillRect(left, y, Math.max(right - left, 1), h);
    };
    if (run.horizon.t !== null) band(run.horizon.t, run.tEnd, paints.shade, 0, height);
    if (run.transient_s > from) band(from, Math.min(run.transient_s, to), paints.shade, 0, height);
    if (close) {
      const { t_start, taut } = run.modes;
      const count = run.lines.length;
      t_start.forEach((t, i) => {
        const high = (5 * taut[i].length) / count;
        if (high) band(t, t_start[i + 1] ?? to, paints.strained, height - high, high);
      });
    } else {
      context.strokeStyle = paints.accent;
      context.lineWidth = 1.5;
      const [a, b] = run.window.map(x);
      context.strokeRect(a, 1, Math.max(b - a, 3), height - 2);
      if (run.preview) {
        context.fillStyle = paints.muted;
        context.fillText("not run yet", x(run.tEnd) + 6, height - 6);
      }
    }
    this.#ticks(context, x, [from, to], height, paints);
  }

  #ticks(context, x, [from, to], height, paints) {
    const { run } = this;
    let pending = null;
    const drawTick = () => {
      if (!pending) return;
      const high = (height - 6) * Math.sqrt(run.hardness[pending.i] / (run.hardest || 1));
      context.fillStyle = lineColour(paints, run.snaps.line[pending.i]);
      context.fillRect(pending.px - 0.6, height - 5 - high, 1.2, high);
    };
    run.snaps.t.forEach((t, i) => {
      if (t < from || t > to) return;
      const px = x(t);
      if (pending && px - pending.px < APART_PX) {
        if (run.hardness[i] > run.hardness[pending.i]) pending.i = i;
        return;
      }
      drawTick();
      pending = { i, px };
    });
    drawTick();
  }
}
