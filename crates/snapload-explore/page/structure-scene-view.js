// The scene of a structure on its canvas, and the description of the run from `snapload assess`.

import { $ } from "./dom.js";
import { prepare } from "./plot.js";
import { paint } from "./shapes.js";
import { structureCamera, structureShapes, structureWords } from "./structure-scene.js";
import { colours, reducedMotion } from "./theme.js";
import { snapWords } from "./structure-charts.js";
import { round, sentence } from "./formatting.js";

/** The delay of texts for screen readers, so that a dragged slider causes one text only. */
const REST_MS = 900;
export class StructureSceneView {
  constructor(state, playback) {
    this.state = state;
    this.playback = playback;
    this.run = null;
    this.announceTimer = null;
    this.fixedCamera = null;
    this.canvas = $("scene");
  }

  setRun(run) {
    this.run = run;
    const { verdict, trust } = run.assessment;
    $("verdict").dataset.standing = verdict.standing;
    $("standing").textContent = run.standing;
    $("message").textContent = verdict.words;
    $("trust").textContent = trust.words;
    const whole = `the whole record of ${round(run.lasts_s)} s, and with it the choice of an interval, follows when the values stop changing`;
    $("preview").textContent = run.preview ? `These results are for the first ${round(run.tEnd)} s; ${whole}.` : "";
    clearTimeout(this.announceTimer);
    const words = sentence(run.standing) + ` ${verdict.words}`;
    this.announceTimer = setTimeout(() => ($("announced").textContent = words), $("announced").textContent ? REST_MS : 0);
  }

  get t() {
    return this.run.nearest(this.state.t);
  }

  draw() {
    const { context, width, height } = prepare(this.canvas);
    const options = { ...this.options(width, height), camera: this.fixedCamera };
    paint(context, structureShapes(this.run, this.t, options));
    this.#caption();
  }

  options(width, height, scheme) {
    const { zoom, speed } = this.state;
    const { playing } = this.playback;
    return { width, height, zoom, speed, playing, colours: colours(scheme), still: reducedMotion.matches };
  }

  /** The current view: the run, its moment, the camera, and the size of the canvas. */
  view() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const cam = this.fixedCamera ?? structureCamera(this.run, this.options(width, height));
    return { run: this.run, moment: this.run.at(this.t), cam, whole: cam.whole, size: { width, height } };
  }

  /** Fixes the camera while something is dragged; null releases it. */
  fixCamera(cam) {
    this.fixedCamera = cam;
  }

  #caption() {
    const { run, t } = this;
    const past = run.beyond(t) ? "; past the horizon" : "";
    const i = run.latestSnap(t);
    const snaps = !this.playback.playing && i >= 0 && run.snaps.t[i] === t ? snapWords(run, i) : "";
    $("caption").textContent = `${snaps || tautWords(run, t)}${past}`;
    if (!this.playback.playing) this.canvas.setAttribute("aria-label", structureWords(run, t));
  }
}

/** The taut lines as text. */
export function tautWords(run, t) {
  const taut = run.tautAt(t);
  if (taut.length === 0) return "all lines slack";
  if (taut.length === run.lines.length) return "all lines taut";
  return `line${taut.length > 1 ? "s" : ""} ${taut.join(", ")} taut`;
}
