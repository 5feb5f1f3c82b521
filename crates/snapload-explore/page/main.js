// Wires state, server, scene, charts and controls together.

import { Refused, Runner, fetchCase, fetchSchema } from "./api.js";
import { Charts } from "./charts.js";
import { $, setProperties } from "./dom.js";
import { EventTable } from "./events.js";
import { Handles } from "./handles.js";
import { Keyboard } from "./keyboard.js";
import { SafeBasin } from "./basin.js";
import { SweepMap } from "./map.js";
import { ExportPanel } from "./export.js";
import { ExactInstants } from "./exact-instants.js";
import { Controls, caseGroups, notOfAPoint } from "./controls.js";
import { Link } from "./link.js";
import { LongRun } from "./long-run.js";
import { acceptCaseFiles, note, keepStructure, reportPaintTime, purposeAndSkip, themeButton } from "./page.js";
import { Outcome } from "./outcome.js";
import { FramedPicture, onResize } from "./plot.js";
import { Playback } from "./playback.js";
import { PinnedRuns } from "./pinned-runs.js";
import { Proof } from "./proof.js";
import { Questions } from "./questions.js";
import { Run } from "./run.js";
import { sceneShapes } from "./scene.js";
import { SceneView } from "./scene-view.js";
import { State } from "./state.js";
import { chooseTheme, chosenTheme, colours, reducedMotion } from "./theme.js";
import { PLANES, Trajectory } from "./trajectory.js";
import { PlaybackControls } from "./playback-controls.js";
import { fixed, modeName } from "./formatting.js";

/** Rows of the motion per request: few, for a fast answer, and more once a long run is not changed any more. */
const SAMPLES = { first: 1200, finer: 3000 };
const LONG_T = 20;
const PURPOSE_READ = "snapload-purpose-read";
const REST_MS = 300;
/** The time after a picture from which on no drag is assumed. */
const TABLES_MS = 100;
/** The longest time without a description of the picture. */
const DESCRIBE_MS = 250;
/** The elements that describe the run. */
const DESCRIPTIONS = ["summary", "message", "outcome", "seal", "prove-message"];

chooseTheme(chosenTheme());

class Page {
  constructor(schema) {
    this.state = new State(schema);
    this.run = null;
    this.moment = new FramedPicture(() => this.#paintMoment());
    this.instants = new ExactInstants("api/instant", { onArrival: () => this.drawMoment() });
    /** The requests of the run that is shown, of the run of the descriptions, and of that in the table of events. */
    this.shown = this.described = this.tabled = null;
    this.hover = null;
    /** The time cursor before a run arrived that ends earlier. */
    this.keptTime = null;
    /** Why the values can not be run. */
    this.refusal = "";
    this.link = new Link(this.state, {
      onBroken: (parts) => note(`Not understood in the link, and ignored: ${parts.join(", ")}`),
      onTravel: () => {
        this.controls.endTyping();
        return true;
      },
    });
    this.playback = new Playback(this.state, () => this.run);
    this.sceneView = new SceneView(this.state, this.playback);
    this.handles = new Handles(this.sceneView, this.state, {
      onChange: (change) => this.changed(change),
      onRelease: () => this.playback.play(),
    });
    this.playbackControls = new PlaybackControls(this.state, this.playback);
    this.playback.onPlaying = (playing) => {
      this.playbackControls.showPlaying(playing);
      // Fading shapes are drawn only during playback.
      this.drawMoment();
    };
    this.controls = new Controls($("controls"), this.state, {
      groups: caseGroups(schema),
      reasonUnavailable: notOfAPoint,
      onChange: (change) => this.changed(change),
    });
    const jump = (t) => {
      this.playback.pause();
      this.playback.seek(t);
    };
    const hover = (t, at) => this.setHover(t === null ? null : { t, at });
    this.charts = new Charts($("charts"), {
      colours,
      onJump: jump,
      onHover: hover,
      onZoom: (window) => this.state.set({ window }),
    });
    this.events = new EventTable({ onJump: jump });
    const study = { colours, own: (name) => this.#own(name), onPick: (values) => this.#startFrom(values) };
    this.map = new SweepMap(this.state, study);
    this.basin = new SafeBasin(this.state, study);
    this.exports = new ExportPanel({
      state: this.state,
      sceneView: this.sceneView,
      currentRun: () => this.run,
      question: () => ({ values: this.state.values, ghost: null, samples: SAMPLES.first }),
      address: () => this.link.address,
      picture: {
        shapes: sceneShapes,
        caption: (run, t) => `t = ${fixed(t, 2)} T · ${modeName(run.tautAt(t))}`,
      },
    });
    const current = () => ({ run: this.run, values: this.question?.values });
    this.pins = new PinnedRuns(this.state, current, { onChange: () => this.drawAll() });
    this.outcome = new Outcome();
    this.proof = new Proof();
    this.questions = new Questions(schema.questions, { values: () => this.state.values });
    this.longRun = new LongRun({
      values: () => this.state.values,
      onPick: (start) => this.#startFrom(start),
    });
    this.trajectory = new Trajectory($("trajectory"), { colours, onJump: jump, onHover: hover });
    this.runner = new Runner({
      onAnswer: (answer, since, question) => this.receive(answer, since, question),
      onError: (error, question) => this.fail(error, question),
    });
    this.state.listen((changed) => this.follow(changed));
    this.keyboard = new Keyboard({
      playback: this.playback,
      playbackControls: this.playbackControls,
      state: this.state,
      map: this.map,
      pins: this.pins,
    });
    this.cases();
    this.tools();
    const fresh = !location.hash;
    this.link.read();
    this.ask();
    // Playback starts when the page is opened; a link is shown at its own time.
    this.playsAtOnce = fresh && !reducedMotion.matches;
    onResize(() => this.redraw());
  }

  /** Changes some values and starts at t = 0 again, as a new entry in the history. */
  #startFrom(values) {
    this.state.set({ values: { ...this.state.values, ...values }, t: 0, window: null });
    this.link.write({ now: true });
  }

  /** The value of a key; that of the run if it is derived, and NaN if there is none. */
  #own(name) {
    return this.state.value(name) ?? this.run?.values[name] ?? NaN;
  }

  /** Follows a change of a value by hand; settled: not being dragged. */
  changed({ since, settled, gesture = null }) {
    this.ask(since);
    this.link.held = !settled;
    if (settled) this.link.write({ now: true, gesture });
  }

  /** Requests the run of the current values, which changed at the time `since`; only once for the same values. */
  ask(since = performance.now()) {
    const { values, ghost } = this.state;
    const asked = keyOf({ values, ghost });
    if (asked === this.asked) return;
    this.asked = asked;
    clearTimeout(this.refining);
    clearTimeout(this.filling);
    this.runner.ask({ values, ghost, samples: SAMPLES.first }, since);
  }

  receive(answer, since, question) {
    this.run = new Run(answer);
    this.question = question;
    this.shown = keyOf(question);
    const latest = this.asked === keyOf(question);
    if (latest) {
      this.refusal = "";
      setProperties($("failed"), { hidden: true });
      this.controls.clearError();
      if (question.ghost === this.state.ghost) this.sceneView.refuseGhost("");
    }
    this.sceneView.setRun(this.run);
    this.playbackControls.setRun(this.run);
    this.#keepTime();
    if (this.state.window?.[0] >= this.run.tEnd) this.state.set({ window: null });
    this.drawAll();
    this.moment.paintNow();
    this.#markStale();
    if (this.playsAtOnce) this.playback.play();
    this.playsAtOnce = false;
    if (question.samples === SAMPLES.first) this.afterwards(since, latest);
    else this.describe();
  }

  /** Updates the descriptions of the picture, once for each run. */
  describe() {
    clearTimeout(this.describing);
    this.describing = null;
    const { run, question } = this;
    if (this.describedRun === run) return;
    this.describedRun = run;
    this.described = this.shown;
    this.sceneView.describe();
    this.outcome.setRun(run, question.values);
    this.proof.setValues(question.values);
    this.#markStale();
    this.map.runChanged();
    this.basin.runChanged();
    if (this.asked === this.shown) this.controls.show(run.values);
  }

  /** Makes descriptions of an earlier run pale next to a newer picture. */
  #markStale() {
    for (const id of DESCRIPTIONS) $(id).classList.toggle("stale", this.described !== this.shown);
  }

  /** A run that ends before the time cursor is shown at its end; a longer one after it at the previous time. */
  #keepTime() {
    const kept = this.keptTime ?? this.state.t;
    this.state.set({ t: Math.min(kept, this.run.tEnd) });
    this.keptTime = kept > this.run.tEnd ? kept : null;
  }

  /** The work after a picture: its time, its descriptions, tables and maps, and more rows of a long run. */
  afterwards(since, latest) {
    reportPaintTime(since, () => this.describe());
    // For pictures that arrive faster than they are painted, and for a hidden page, which paints none.
    this.describing ??= setTimeout(() => this.describe(), DESCRIBE_MS);
    this.#fillTables();
    if (latest) this.#refine();
  }

  /** Tables and maps follow once the values are not changed any more. */
  #fillTables() {
    clearTimeout(this.filling);
    this.filling = setTimeout(() => {
      if (!this.run) return;
      this.events.setRun(this.run);
      this.tabled = this.shown;
      this.#showEvents(true);
      this.exports.setRun(this.run);
    }, TABLES_MS);
  }

  /** Requests more rows of a long run that is not changed any more, above all in the time window. */
  #refine() {
    clearTimeout(this.refining);
    const { values, ghost, t } = this.state;
    if (this.run.tEnd < LONG_T) return;
    const window = this.state.window ?? [Math.max(t - LONG_T, 0), t + LONG_T];
    this.refining = setTimeout(() => {
      if (this.asked !== keyOf({ values, ghost }) || this.playback.playing) return;
      this.runner.ask({ values, ghost, samples: SAMPLES.finer, window }, performance.now());
    }, REST_MS);
  }

  fail(error, question) {
    if (error.key === "ghost") return this.failGhost(error, question);
    // What is shown instead may be refused, too: the reason is that of the values asked for.
    if (keyOf(question) === this.asked || !this.refusal) {
      this.controls.showError(error);
      this.refusal = error.message;
    }
    // A program that did not answer may answer the same question later.
    if (keyOf(question) === this.asked && !(error instanceof Refused)) this.asked = null;
    this.#fillTables();
    const instead = this.run ? null : this.#instead(question);
    const shown = this.run ? "the last values that could be run" : instead?.words;
    $("failed").textContent = `Not run: ${this.refusal}${shown ? `\nThe picture shows ${shown}.` : ""}`;
    $("failed").hidden = false;
    if (!instead) return;
    this.runner.askInstead({ values: instead.values, ghost: null, samples: SAMPLES.first }, performance.now());
  }

  /** The case to show after one that can not be run: the first one of the page, then the standard case, then none. */
  #instead(question) {
    const { start } = this.state.schema;
    const standard = { values: {}, words: "the standard case" };
    const first = { values: start.values, words: `the first case of the page, ${start.name}` };
    const failed = ({ values }) => keyOf({ values, ghost: null }) === keyOf(question);
    return failed(standard) ? null : failed(first) ? standard : first;
  }

  /** Requests the run without the ghost if only the ghost can not be run. */
  failGhost(error, question) {
    this.sceneView.refuseGhost(error.message);
    this.controls.clearError();
    $("failed").hidden = true;
    // A newer request is waiting already and must not be replaced by this one.
    if (this.asked !== keyOf(question)) return;
    const alone = { ...question, ghost: null };
    this.asked = keyOf(alone);
    this.runner.ask(alone, performance.now());
  }

  /** Redraws what depends on a change of the state. */
  follow(changed) {
    if (changed.has("t")) this.keptTime = null;
    if (changed.has("values")) {
      // They are about the values of the fields, which may be refused, and not about the run that is shown.
      this.longRun.setValues(this.state.values);
      this.questions.setValues(this.state.values);
    }
    if (changed.has("values") || changed.has("ghost")) {
      this.controls.show(this.run?.values);
      this.showCase();
      // The controls request the run of their own changes, with the time of the event.
      queueMicrotask(() => this.ask());
    }
    if (changed.has("pins")) this.pins.follow();
    if (["picture", "view", "zoom", "window", "plane"].some((name) => changed.has(name))) this.drawAll();
    else if (changed.has("t") || changed.has("speed")) this.drawMoment();
    if (this.run && (changed.has("window") || (changed.has("t") && this.run.at(this.state.t).far))) this.#refine();
    if (changed.has("values") || changed.has("map")) this.map.follow();
    if (changed.has("values") || changed.has("basin")) this.basin.follow();
    setProperties($("axes"), { value: this.state.plane });
    this.sceneView.showChoices();
    this.playbackControls.show();
    this.link.write();
  }

  setHover(hover) {
    this.hover = hover;
    this.drawMoment();
  }

  /** Redraws everything, for example after a change of the theme or of the window's size. */
  redraw() {
    this.drawAll();
    this.map.draw();
    this.basin.draw();
  }

  drawAll() {
    if (!this.run) return;
    const { kept } = this.pins;
    this.charts.draw(this.run, this.state.window, kept);
    this.trajectory.draw(this.run, this.state, kept);
    this.playbackControls.draw();
    this.pins.show();
    this.drawMoment();
  }

  drawMoment() {
    if (this.run) this.moment.request();
  }

  #paintMoment() {
    const read = this.run.nearest(this.hover?.t ?? this.state.t);
    this.instants.follow(this.run, { values: this.question.values }, read);
    this.sceneView.draw();
    this.charts.cursor(this.state.t, this.hover);
    this.trajectory.cursor(this.state.t, this.hover);
    this.playbackControls.show();
    this.#showEvents(!this.playback.playing);
  }

  /** Marks the current event in the table, which is pale while it belongs to an earlier run. */
  #showEvents(follow) {
    const old = this.tabled !== this.shown;
    this.events.setOld(old);
    if (!old) this.events.show(this.state.t, follow);
  }

  cases() {
    const select = $("case");
    const { start, cases } = this.state.schema;
    const own = cases.some(({ code }) => code === start.name) ? [] : [new Option(start.name, start.name)];
    const thesis = document.createElement("optgroup");
    thesis.label = "Cases of the thesis";
    for (const { code, title, happens } of cases) {
      thesis.append(new Option(happens ? `${code}: ${happens} (${title})` : `${code}  ${title}`, code));
    }
    select.append(...own, thesis, new Option("your own values", ""));
    select.addEventListener("change", () => {
      if (!select.value) return this.showCase();
      const { values } = cases.find(({ code }) => code === select.value) ?? start;
      this.state.set({ values: { ...values }, t: 0, window: null });
      this.link.write({ now: true });
    });
    this.showCase();
  }

  showCase() {
    const name = this.state.caseName;
    setProperties($("case"), { value: name ?? "" });
    setProperties($("case").lastElementChild, { hidden: name !== null });
  }

  /** Opens a case file; that of a structure opens the page of structures. */
  async open(file) {
    const { structure, values } = await fetchCase(file);
    if (structure) {
      location.href = await keepStructure(file);
      return;
    }
    note("");
    this.state.set({ values, t: 0, window: null });
    this.link.write({ now: true });
  }

  tools() {
    themeButton(() => this.redraw());
    acceptCaseFiles((file) => this.open(file));
    purposeAndSkip(PURPOSE_READ);
    for (const [name, { words }] of Object.entries(PLANES)) $("axes").append(new Option(words, name));
    $("axes").addEventListener("change", () => this.state.set({ plane: $("axes").value }));
  }
}

const keyOf = ({ values, ghost }) => JSON.stringify([values, ghost]);

try {
  new Page(await fetchSchema());
} catch (error) {
  note(`The page could not start: ${error.message}. Is snapload explore still running?`);
  throw error;
}
