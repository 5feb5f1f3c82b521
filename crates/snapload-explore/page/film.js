// The animation as a WebM file: the scene is played on a canvas, and the browser records it as it goes.

import { paint } from "./shapes.js";
import { sceneShapes } from "./scene.js";
import { colours } from "./theme.js";
import { fixed, modeName } from "./words.js";

const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
const FRAMES_A_SECOND = 30;
const LONGEST_S = 600;
const REST_S = 0.7;
const PATIENCE_S = 10;
const BITS_A_SECOND = 6e6;

export class Film {
  constructor({ run, from, to, options, size }) {
    Object.assign(this, { run, from, to, options, size, cancelled: false });
  }

  cancel() {
    this.cancelled = true;
  }

  /** Records it at the speed of the page; gives the file, or nothing if it was cancelled. */
  async record(onProgress) {
    const kind = globalThis.MediaRecorder && KINDS.find((one) => MediaRecorder.isTypeSupported(one));
    if (!kind || !HTMLCanvasElement.prototype.captureStream) {
      throw new Error("This browser can record no WebM. Firefox, Chromium and their kin can; or take the pictures.");
    }
    const seconds = (this.to - this.from) / this.options.speed;
    if (seconds > LONGEST_S) {
      throw new Error(
        `This would take ${fixed(seconds / 60, 0)} minutes: it is recorded as it is played. ` +
          "Raise the speed, or zoom in on the time that matters.",
      );
    }
    const canvas = document.createElement("canvas");
    Object.assign(canvas, this.size);
    const context = canvas.getContext("2d");
    this.#frame(context, this.from);
    const recorder = new MediaRecorder(canvas.captureStream(FRAMES_A_SECOND), {
      mimeType: kind,
      videoBitsPerSecond: BITS_A_SECOND,
    });
    const pieces = [];
    recorder.ondataavailable = (event) => pieces.push(event.data);
    const ended = new Promise((done, failed) => {
      recorder.onstop = done;
      recorder.onerror = (event) =>
        failed(new Error(`The recording failed: ${event.error?.message ?? "unknown cause"}`));
    });
    recorder.start(500);
    await this.#play(context, seconds, onProgress);
    await this.#rest(context, () => pieces.some((piece) => piece.size > 0));
    recorder.stop();
    await ended;
    if (this.cancelled) return null;
    const film = new Blob(pieces, { type: "video/webm" });
    if (film.size === 0)
      throw new Error("The browser recorded no picture. Close other pages, and try again with this one in view.");
    return film;
  }

  /** The end stands for a moment, and until a busy machine has written its first pictures. */
  async #rest(context, written) {
    for (let waited = 0; !this.cancelled && (waited < REST_S || (!written() && waited < PATIENCE_S)); waited += 0.1) {
      this.#frame(context, this.to);
      await new Promise((done) => setTimeout(done, 100));
    }
  }

  #play(context, seconds, onProgress) {
    return new Promise((done) => {
      let elapsed = 0;
      let before = null;
      const tick = (time) => {
        // A page that was hidden goes on from where it was.
        elapsed += before === null ? 0 : Math.min((time - before) / 1000, 0.2);
        before = time;
        const part = Math.min(elapsed / seconds, 1);
        this.#frame(context, this.from + (this.to - this.from) * part);
        onProgress(part, seconds - elapsed);
        if (this.cancelled || part >= 1) setTimeout(done, 1000 / FRAMES_A_SECOND);
        else requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    });
  }

  #frame(context, t) {
    const { width, height } = this.size;
    const paints = colours();
    context.fillStyle = paints.paper;
    context.fillRect(0, 0, width, height);
    const past = this.run.beyond(t) ? " · past the horizon of trust" : "";
    const words = `t = ${fixed(t, 2)} T · ${modeName(this.run.tautAt(t))}${past}`;
    const caption = {
      text: words,
      at: [14, this.options.picture === "real" ? 26 : height - 14],
      size: 15,
      fill: paints.ink,
    };
    paint(context, [...sceneShapes(this.run, t, this.options), caption]);
  }
}
