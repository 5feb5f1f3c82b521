// The animation as a WebM file: each frame of the scene is drawn at its own time and encoded, as fast as the browser
// can.

import { paint } from "./shapes.js";
import { colours } from "./theme.js";
import { webm } from "./webm.js";
import { fixed } from "./formatting.js";

/** The names of codecs in browsers and in the file. */
const CODECS = [
  ["vp09.00.31.08", "V_VP9"],
  ["vp8", "V_VP8"],
];
const FRAMES_A_SECOND = 30;
const MOST_PICTURES = 36_000;
/** A player can seek to a key frame: there is one a second. */
const KEY_EVERY = FRAMES_A_SECOND;
const REST_S = 0.7;
const BITS_A_SECOND = 6e6;
/** The most frames that wait to be encoded. */
const MOST_WAITING = 8;
/** The time after which an encoder without output counts as failed, for example because the browser closed it. */
const STANDS_STILL_MS = 30_000;

/**
 * A pause in which the page stays responsive. A hidden page runs a timer at most once a second and would need an hour
 * for an animation of two minutes; messages are not delayed.
 */
const pause = () =>
  new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      done(null);
    };
    port2.postMessage(null);
  });

export class AnimationRecording {
  /** `picture` makes the shapes and the caption of a run at a time. */
  constructor({ run, picture, from, to, options, size }) {
    this.run = run;
    this.picture = picture;
    this.from = from;
    this.to = to;
    this.options = options;
    this.size = size;
    this.cancelled = false;
  }

  cancel() {
    this.cancelled = true;
  }

  /** Encodes it, to be played at the speed of the page; returns the file, or nothing if it was cancelled. */
  async record(onProgress) {
    const [codec, name] = await this.#codec();
    const seconds = (this.to - this.from) / this.options.speed;
    const moving = Math.max(Math.round(seconds * FRAMES_A_SECOND), 1);
    const count = moving + Math.round(REST_S * FRAMES_A_SECOND);
    if (count > MOST_PICTURES) {
      const minutes = fixed(MOST_PICTURES / FRAMES_A_SECOND / 60, 0);
      throw new Error(
        `This animation would last ${fixed(seconds / 60, 0)} minutes; at most ${minutes} are allowed. ` +
          "Raise the speed, or zoom in on a shorter interval.",
      );
    }
    const pictures = await this.#encode(codec, moving, count, onProgress);
    return pictures && webm({ codec: name, ...this.size, framesASecond: FRAMES_A_SECOND, pictures });
  }

  async #codec() {
    const encoder = globalThis.VideoEncoder;
    for (const pair of encoder ? CODECS : []) {
      const { supported } = await encoder.isConfigSupported(this.#settings(pair[0]));
      if (supported) return pair;
    }
    throw new Error("This browser can not encode video (WebCodecs). Use a newer one, or save single pictures.");
  }

  #settings(codec) {
    return { codec, ...this.size, bitrate: BITS_A_SECOND, framerate: FRAMES_A_SECOND };
  }

  async #encode(codec, moving, count, onProgress) {
    const pictures = [];
    let failure = null;
    let fail;
    const failed = new Promise((done) => {
      fail = (error) => {
        failure ??= error;
        done(null);
      };
    });
    let lastOutputAt = performance.now();
    const encoder = new VideoEncoder({
      output: (chunk) => {
        lastOutputAt = performance.now();
        const data = new Uint8Array(chunk.byteLength);
        chunk.copyTo(data);
        pictures.push({ data, time: Math.round(chunk.timestamp / 1000), key: chunk.type === "key" });
      },
      error: fail,
    });
    const watch = setInterval(() => {
      if (performance.now() - lastOutputAt > STANDS_STILL_MS) fail(new Error("the encoder stopped responding; try again"));
    }, 1000);
    const dequeued = () => new Promise((done) => encoder.addEventListener("dequeue", done, { once: true }));
    encoder.configure(this.#settings(codec));
    const canvas = document.createElement("canvas");
    Object.assign(canvas, this.size);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    try {
      for (let i = 0; i < count && !this.cancelled && !failure; i += 1) {
        this.#paint(context, this.from + (this.to - this.from) * Math.min(i / moving, 1));
        const frame = new VideoFrame(canvas, { timestamp: Math.round((i * 1e6) / FRAMES_A_SECOND) });
        encoder.encode(frame, { keyFrame: i % KEY_EVERY === 0 });
        frame.close();
        await pause();
        while (encoder.encodeQueueSize > MOST_WAITING && !failure) await Promise.race([failed, dequeued()]);
        onProgress((i + 1) / count);
      }
      if (!this.cancelled && !failure) await Promise.race([failed, encoder.flush().catch(fail)]);
    } finally {
      clearInterval(watch);
      if (encoder.state !== "closed") encoder.close();
    }
    if (failure) throw new Error(`The animation could not be encoded: ${failure.message}`);
    return this.cancelled ? null : pictures;
  }

  #paint(context, t) {
    const { width, height } = this.size;
    const paints = colours();
    context.fillStyle = paints.paper;
    context.fillRect(0, 0, width, height);
    const past = this.run.beyond(t) ? " · past the horizon of trust" : "";
    const caption = {
      text: `${this.picture.caption(this.run, t, this.options.speed)}${past}`,
      at: [14, this.options.picture === "thesis" ? height - 14 : 26],
      size: 15,
      fill: paints.ink,
      // The water's surface may pass behind it.
      halo: paints.paper,
    };
    paint(context, [...this.picture.shapes(this.run, t, this.options), caption]);
  }
}
