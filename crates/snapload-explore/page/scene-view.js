// The scene on its canvas, the description of the run, and the options of the scene.

import { $, setAttributes, setProperties } from "./dom.js";
import { eventWords } from "./events.js";
import { prepare } from "./plot.js";
import { readValue } from "./state.js";
import { paint } from "./shapes.js";
import { camera, sceneShapes, sceneWords } from "./scene.js";
import { colours, reducedMotion } from "./theme.js";
import { about, modeName, number, fieldText, withSymbols, sentence } from "./formatting.js";

/** The delay of texts for screen readers, so that a dragged slider causes one text only. */
const REST_MS = 900;

/** @returns {Iterable<any>} The radio buttons of a name. */
const radios = (name) => document.getElementsByName(name);

export class SceneView {
  constructor(state, playback) {
    this.state = state;
    this.playback = playback;
    this.run = null;
    this.announceTimer = null;
    this.fixedCamera = null;
    this.canvas = $("scene");
    for (const name of ["picture", "view"]) {
      for (const radio of radios(name)) {
        radio.addEventListener("change", () => state.set({ [name]: radio.value, zoom: null }));
      }
    }
    const ghost = () => {
      this.refuseGhost("");
      if (!$("ghost").checked) return state.set({ ghost: null });
      const text = $("ghost-size").value.trim();
      const size = readValue({ kind: { type: "number" } }, text);
      if (size === undefined) this.refuseGhost(`ghost = "${text}" is not allowed; allowed: a number, such as 1e-6`);
      else state.set({ ghost: size });
    };
    $("ghost").addEventListener("change", ghost);
    $("ghost-size").addEventListener("change", ghost);
  }

  /** Shows at its field why the ghost can not be run; an empty text clears it. */
  refuseGhost(text) {
    setProperties($("error-ghost"), { textContent: text, hidden: !text });
    setAttributes($("ghost-size"), { "aria-invalid": text ? "true" : null });
  }

  setRun(run) {
    this.run = run;
  }

  /** Shows the outcome of the run. */
  describe() {
    const { run } = this;
    this.#summarise();
    clearTimeout(this.announceTimer);
    const words = this.#words();
    $("message").textContent = words;
    this.announceTimer = setTimeout(() => ($("announced").textContent = words), $("announced").textContent ? REST_MS : 0);
    $("ramp-key").hidden = !(run.timeTaut > 0);
    $("ramp-words").textContent = `tension, up to about ${number(run.mostTension, 2)} F`;
  }

  /** The end of the run, its horizon of trust, and when its neighbour separates from it, in a sentence each. */
  #words() {
    const { end, horizon, ghost, cut } = this.run;
    const parts = [end.words, horizon.words].flatMap((words) => withSymbols(words).split("\n").map(sentence));
    if (ghost) {
      const apart =
        ghost.parts_at === null ? "stays within 1e−3 while both last" : `is 1e−3 away at t = ${number(ghost.parts_at, 5)}`;
      parts.push(`The ghost, started ${number(Math.abs(ghost.by))} away in ${ghost.key}, ${apart}.`);
      if (ghost.end.reason !== end.reason) parts.push(`It ends otherwise: ${withSymbols(ghost.end.words)}.`);
    }
    if (this.run.ghost_error) parts.push(sentence(`no ghost: ${this.run.ghost_error}`));
    if (cut) {
      const rows = `${cut.shown} of ${cut.impacts} rows of impacts`;
      parts.push(`Events are shown up to t = ${number(cut.until, 6)}, ${rows}; after that only the mode where the time cursor rests.`);
    }
    return parts.join(" ");
  }

  #summarise() {
    const { norms, snaps, timeTaut, geometry } = this.run;
    // A point mass has no rotation.
    const turns = geometry.body.kind !== "point";
    const theta = ["|<i>θ</i>|<sub>max</sub>", `${number(norms.theta_max, 5)} rad`, "theta_max"];
    const rows = [
      ["Impacts", String(snaps), "impacts"],
      ["ρ<sub>1</sub> = max <i>v</i><sub>n</sub>", number(norms.rho1, 5), "rho1"],
      ["ρ<sub>2</sub> to t = 10", number(norms.rho2, 5), "rho2"],
      ["ρ<sub>3</sub> = Σ <i>v</i><sub>n</sub>", number(norms.rho3, 5), "rho3"],
      ["<i>y</i><sub>max</sub>", `${number(norms.y_max, 5)} L`, "y_max"],
      ...(turns ? [theta] : []),
      ["Largest impulse", `${number(this.run.hardest, 5)} m L/T`, "impulse"],
      ["Time taut", `${number(timeTaut, 4)} T`, "taut"],
    ];
    // Counts over the whole run are no more certain than its end.
    const sums = this.run.horizon.t === null ? "" : "not certain";
    const cut = this.run.cut ? "of the impacts shown" : "";
    // The largest impulse is no more certain than the largest velocity.
    const known = this.run.norms_known;
    const largest = known.rho1 === "not certain" ? known.rho1 : "";
    const notes = { impacts: sums, taut: cut || sums, impulse: cut || largest, ...known };
    $("summary").innerHTML = rows
      .map(([term, value, name = ""]) => {
        const sum = `<span data-norm="${name}">${value}</span>`;
        return `<div><dt>${term}</dt><dd>${sum}${notes[name] ? ` <small>${notes[name]}</small>` : ""}</dd></div>`;
      })
      .join("");
  }

  draw() {
    const { run, canvas, state } = this;
    const { context, width, height } = prepare(canvas);
    const options = { ...this.options(width, height), camera: this.fixedCamera };
    paint(context, sceneShapes(run, run.nearest(state.t), options));
    this.#caption();
  }

  options(width, height, scheme) {
    const { picture, view, zoom, speed } = this.state;
    const { playing } = this.playback;
    return { width, height, picture, view, zoom, speed, playing, colours: colours(scheme), still: reducedMotion.matches };
  }

  /** The current view: the run, its moment, the camera, and the size of the canvas. */
  view() {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const cam = this.fixedCamera ?? camera(this.run, this.options(width, height));
    const moment = this.run.at(this.run.nearest(this.state.t));
    return { run: this.run, moment, cam, whole: cam.whole, size: { width, height } };
  }

  /** Fixes the camera while something is dragged; null releases it. */
  fixCamera(cam) {
    this.fixedCamera = cam;
  }

  #caption() {
    const t = this.run.nearest(this.state.t);
    const moment = this.run.at(t);
    const past = this.run.beyond(t) ? ", past the horizon" : "";
    const taut = moment.taut?.length
      ? `, ${about(moment)}${moment.taut.map((cable) => number(moment.tensions[cable - 1], 3)).join(" and ")} F`
      : "";
    const happens = this.playback.playing ? "" : eventWords(this.run, t);
    setProperties($("caption"), { textContent: `${happens ? `${happens}; ` : ""}${modeName(moment.taut)}${taut}${past}` });
    if (!this.playback.playing) setAttributes(this.canvas, { "aria-label": sceneWords(this.run, t) });
  }

  /** Shows the chosen options of the scene. */
  showChoices() {
    const { picture, view, ghost } = this.state;
    for (const [name, value] of Object.entries({ picture, view })) {
      for (const radio of radios(name)) setProperties(radio, { checked: radio.value === value });
    }
    setProperties($("ghost"), { checked: ghost !== null });
    if (ghost !== null) setProperties($("ghost-size"), { value: fieldText(ghost) });
  }
}
