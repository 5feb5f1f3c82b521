// The page of a structure: wires state, server, scene, charts and tables together.

import { Refused, Runner, fetchCase, fetchLong, fetchStructureFile, fetchStructures, fetchWithProgress } from "./api.js";
import { Controls } from "./controls.js";
import { $ } from "./dom.js";
import { Keyboard, timeKeys } from "./keyboard.js";
import { Link } from "./link.js";
import {
  acceptCaseFiles,
  caseFragment,
  note,
  keepStructure,
  keptStructure,
  reportPaintTime,
  purposeAndSkip,
  themeButton,
} from "./page.js";
import { FramedPicture, onResize } from "./plot.js";
import { Playback } from "./playback.js";
import { chooseTheme, chosenTheme, colours, lineColour, reducedMotion } from "./theme.js";
import { StructureCharts, breakingLoads } from "./structure-charts.js";
import { filmCaption, structureKeyGroups, reasonUnavailable } from "./structure-key-groups.js";
import { StructureHandles } from "./structure-handles.js";
import { StructureInterval } from "./structure-interval.js";
import { PinnedAnswers } from "./structure-pinned-answers.js";
import { StructureRun } from "./structure-run.js";
import { structureShapes } from "./structure-scene.js";
import { StructureSceneView } from "./structure-scene-view.js";
import { StructureState, brokenLinkWords, caseOfFragment, identityOf } from "./structure-state.js";
import { showChecks, showLines, showSnaps } from "./structure-tables.js";
import { StructurePlaybackControls } from "./structure-playback-controls.js";
import { StructureWaves } from "./structure-waves.js";
import { ExactInstants } from "./exact-instants.js";
import { ExportPanel } from "./export.js";
import { round } from "./formatting.js";

/** Neighbours and elastic lines are computed this long after the last change of values. */
const REST_MS = 300;
/** The longest record whose neighbours and elastic lines are computed here [s]: those of longer ones may take minutes. */
const LONGEST_WITH_NEIGHBOURS = 1200;
const PURPOSE_READ = "snapload-structure-purpose-read";

chooseTheme(chosenTheme());

class Page {
  constructor(schema, opened, file) {
    this.state = new StructureState(schema, opened, file);
    this.run = null;
    this.moment = new FramedPicture(() => this.#paintMoment());
    this.instants = new ExactInstants("api/structure/instant", { onArrival: () => this.drawMoment() });
    this.hover = null;
    this.background = null;
    /** Why the values can not be run. */
    this.refusal = "";
    /** The question whose answer is shown in place of that of refused values; no other answer follows it. */
    this.instead = null;
    /** The time cursor of a part of the record that is not run yet. */
    this.keptTime = null;
    this.link = new Link(this.state, {
      onBroken: (parts) => note(brokenLinkWords(parts)),
      onTravel: () => this.travel(),
    });
    this.interval = new StructureInterval(this.state, () => this.run);
    this.playback = new Playback(this.state, () => this.run, this.interval);
    this.sceneView = new StructureSceneView(this.state, this.playback);
    this.playbackControls = new StructurePlaybackControls(this.state, this.playback, {
      onInterval: (from) => this.interval.moveTo(from),
    });
    this.playback.onPlaying = (playing) => {
      this.playbackControls.showPlaying(playing);
      this.drawMoment();
    };
    this.link.read();
    this.controls = new Controls($("controls"), this.state, {
      groups: structureKeyGroups(this.state),
      reasonUnavailable,
      onChange: (change) => this.changed(change),
    });
    this.handles = new StructureHandles(this.sceneView, this.state, {
      onChange: (change) => this.changed(change),
      onRelease: () => this.playback.play(),
    });
    this.charts = new StructureCharts($("charts"), {
      colours,
      onJump: (t) => this.jump(t),
      onHover: (t, at) => this.setHover(t === null ? null : { t, at }),
      onZoom: (window) => this.state.set({ window }),
    });
    this.exports = new ExportPanel({
      state: this.state,
      sceneView: this.sceneView,
      currentRun: () => this.run,
      question: () => ({ case: this.state.asked }),
      address: () => this.link.address,
      path: "api/structure/export",
      slowFiles: ["note.html", "assess.json"],
      picture: { shapes: structureShapes, caption: (run, t, speed) => filmCaption(this.state, run, t, speed) },
    });
    this.pins = new PinnedAnswers(this.state, () => this.run, { onBack: (pin) => this.restore(pin) });
    this.waves = new StructureWaves(this.state, {
      onPick: (values) => {
        this.state.setValues(values);
        this.link.write({ now: true });
      },
    });
    this.runner = new Runner({
      path: "api/structure/run",
      onAnswer: (answer, since, question) => this.receive(answer, since, question),
      onError: (error, question) => this.fail(error, question),
    });
    this.state.listen((changed) => this.follow(changed));
    new Keyboard({ playback: this.playback }, [
      ...timeKeys(this),
      [["g"], "g", "elastic lines, on or off", () => $("elastic").click()],
      [["l"], "l", "loop on or off", () => this.state.set({ loop: !this.state.loop })],
      [["p"], "p", "pin this answer", () => this.pins.add()],
      [["?"], "?", "this help", () => $("help").click()],
    ]);
    this.tools();
    this.showChoices();
    this.playsAtOnce = !location.hash && !reducedMotion.matches;
    this.ask();
    onResize(() => this.drawAll());
  }

  get question() {
    return { case: this.state.asked, window: this.state.window };
  }

  /** Follows a change of a value by hand; settled: not being dragged. */
  changed({ since, settled, gesture = null }) {
    this.ask(since);
    this.link.held = !settled;
    if (settled) this.link.write({ now: true, gesture });
  }

  /** Requests the run of the current values; only once for the same values. */
  ask(since = performance.now()) {
    const asked = keyOf(this.question);
    if (asked === this.asked) return;
    this.asked = asked;
    this.instead = null;
    this.stopBackground();
    this.runner.ask(this.question, since);
  }

  /** Cancels further work, which belongs to earlier values. */
  stopBackground() {
    clearTimeout(this.resting);
    this.background?.abort();
    this.background = null;
    this.#showProgress("");
    $("elastic-message").textContent = "";
  }

  receive(answer, since, question) {
    this.stopBackground();
    const before = this.run;
    this.run = new StructureRun(answer, question.case);
    // Results for elastic lines stay valid for another interval of the same run.
    this.sameCase = before !== null && keyOf(before.ofCase) === keyOf(question.case);
    const latest = this.asked === keyOf(question);
    const last = latest || this.instead === keyOf(question);
    this.show(last);
    if (this.playsAtOnce) this.playback.play();
    this.playsAtOnce = false;
    reportPaintTime(since);
    if (latest) {
      this.refusal = "";
      $("failed").hidden = true;
      this.controls.clearError();
      this.controls.show(this.run.effective(this.state));
    }
    if (last) this.#goOn(this.sameCase ? 0 : REST_MS);
  }

  /** Completes the answer that is shown, if no other takes its place before. */
  #goOn(after_ms) {
    this.#showProgress(this.#toCome());
    this.resting = setTimeout(() => this.computeFurther(), after_ms);
  }

  /** Shows the current run; latest: that of the current values, and not of earlier ones while others are on their way. */
  show(latest = true) {
    const { run, state } = this;
    this.sceneView.setRun(run);
    this.playbackControls.setRun(run);
    const kept = this.keptTime ?? state.t;
    const within = (window) => kept >= window[0] && kept <= window[1];
    // While the answer for another interval is on its way, the time cursor may be there already.
    const there = within(run.window) || (!latest && state.window && within(state.window));
    const t = there ? kept : run.window[0];
    if (latest) this.#keepWindow();
    state.set({ t });
    this.keptTime = run.isBeyond(kept) ? kept : null;
    showLines(run);
    showChecks(run);
    showSnaps(run);
    this.exports.setRun(run);
    this.#legend();
    this.drawAll();
  }

  /** Keeps the interval chosen by the server while values change, so that only one thing changes at a time. */
  #keepWindow() {
    const { run, state } = this;
    // An interval that is not run yet comes back with the whole record.
    if (state.window && run.isBeyond(state.window[1])) return;
    const chosen = state.window === null;
    this.asked = keyOf({ case: state.asked, window: run.window });
    state.set({ window: run.window });
    // It belongs to the entry of the history that was made without an interval.
    if (chosen) this.link.write({ now: true, sameEntry: true });
  }

  /** After the last change: the whole of a long record, neighbours, and elastic lines, one after the other. */
  async computeFurther() {
    this.stopBackground();
    this.#showProgress(this.#toCome());
    const { state } = this;
    // Of the run that is shown: other values may be refused.
    const question = { case: this.run.ofCase, window: state.window };
    const abort = (this.background = new AbortController());
    const current = () => this.background === abort;
    const more = async (how) => {
      const onProgress = ({ doing, percent }) => current() && this.#showProgress(`${doing}, ${percent} %`);
      const text = await fetchWithProgress("api/structure/run", { ...question, ...how }, abort.signal, onProgress);
      if (!current()) return;
      this.run = new StructureRun(JSON.parse(text), question.case);
      this.#showProgress(this.#toCome());
      // Other values may have been asked for since.
      this.show(keyOf(question.case) === keyOf(state.asked));
    };
    try {
      if (this.run.preview) await more({ whole: true });
      if (!current()) return;
      if (this.#toCome()) await more({ whole: true, neighbours: true });
      else if (!this.run.hasOtherRuns) $("preview").textContent = `Neighbours, other restitutions and slightly other waves of so long a record are run by the command: ${this.run.shell}`;
      if (current() && state.elastic && !this.run.elastic) await this.#computeElastic({ case: question.case, window: this.run.window }, abort);
    } catch (error) {
      if (error.name === "AbortError" || !current()) return;
      this.#showProgress("");
      $("preview").textContent = error.message;
    }
  }

  /** What may still change the verdict. */
  #toCome() {
    const { lasts_s, hasOtherRuns } = this.run;
    return lasts_s <= LONGEST_WITH_NEIGHBOURS && !hasOtherRuns ? "neighbours to come" : "";
  }

  /** Shows the progress of the work after the picture. */
  #showProgress(words) {
    $("coming").textContent = words;
  }

  async #computeElastic(question, abort) {
    if (this.run.lasts_s > LONGEST_WITH_NEIGHBOURS) {
      const command = this.run.shell.replace("snapload assess", "snapload elastic");
      $("elastic-words").textContent = `Elastic lines of so long a record are run by the command: ${command}`;
      return;
    }
    $("elastic-message").textContent = "computing…";
    try {
      const answer = await fetchLong("api/structure/elastic", question, abort.signal);
      if (this.background !== abort) return;
      this.run.setElastic(answer);
      $("elastic-message").textContent = "";
      showLines(this.run);
      this.drawAll();
    } catch (error) {
      if (error.name === "AbortError") return;
      $("elastic-message").textContent = error.message.split("\n")[0];
    }
  }

  fail(error, question) {
    const latest = this.asked === keyOf(question);
    // What is shown instead may be refused, too: the reason is that of the values asked for.
    if (latest || !this.refusal) {
      this.controls.showError(error);
      this.refusal = error.message;
    }
    const refused = error instanceof Refused;
    // A program that did not answer may answer the same question later.
    if (latest && !refused) this.asked = null;
    const instead = latest && refused ? this.#insteadOf(question) : null;
    const shown = this.run ? "the last values that could be run" : instead && "the case without changes";
    $("failed").textContent = `Not run: ${this.refusal}${shown ? `\nThe page shows ${shown}.` : ""}`;
    $("failed").hidden = false;
    if (instead) {
      this.instead = keyOf(instead);
      this.runner.askInstead(instead, performance.now());
    } else if (this.run && (latest || this.instead === keyOf(question))) {
      this.interval.stay();
      this.#goOn(REST_MS);
    }
  }

  /**
   * The question that is asked in place of a refused one: of the case without changes, or, once a run is shown, of its
   * case if the interval was moved. Null if nothing else can be shown.
   */
  #insteadOf(question) {
    const { run, state } = this;
    const instead = { case: run?.ofCase ?? { ...question.case, set: [], water: null }, window: state.window };
    const moved = !run || keyOf(run.intervalToCome(state.window)) !== keyOf(run.window);
    return moved && keyOf(instead) !== keyOf(question) ? instead : null;
  }

  /** Redraws what depends on a change of the state. */
  follow(changed) {
    if (changed.has("t")) this.keptTime = null;
    if (changed.has("values") || changed.has("water")) {
      this.controls.show(this.run?.effective(this.state));
      queueMicrotask(() => this.ask());
    }
    if (changed.has("window")) queueMicrotask(() => this.ask());
    if (changed.has("elastic")) {
      if (!this.state.elastic) this.run?.setElastic(null);
      $("elastic-message").textContent = "";
      if (this.run) showLines(this.run);
      if (this.state.elastic && this.run) this.computeFurther();
    }
    if (["zoom", "window", "elastic"].some((name) => changed.has(name))) this.drawAll();
    else if (changed.has("t") || changed.has("speed")) this.drawMoment();
    this.showChoices();
    this.playbackControls.show();
    this.link.write();
  }

  showChoices() {
    const { waterNow, elastic } = this.state;
    for (const radio of /** @type {Iterable<any>} */ (document.getElementsByName("water"))) {
      radio.checked = radio.value === waterNow;
    }
    $("elastic").checked = elastic;
    this.waves.follow();
    $("elastic-key").hidden = !this.run?.elasticAt;
    $("elastic-past").hidden = !((this.run?.elasticHorizon ?? Infinity) < this.run?.window[1]);
    for (const group of document.querySelectorAll(".group[data-water]")) {
      /** @type {HTMLElement} */ (group).hidden = /** @type {HTMLElement} */ (group).dataset.water !== waterNow;
    }
  }

  /** The colours and marks of the lines, and their breaking loads. */
  #legend() {
    const marks = ["×", "○", "△", "□", "+", "◇"];
    const paints = colours();
    const lines = this.run.lines.map(({ line }) => {
      const mark = marks[(line - 1) % marks.length];
      return `<span style="color:${lineColour(paints, line)}">${mark} line ${line}</span>`;
    });
    const loads = breakingLoads(this.run).map((load) => `<span class="breaking">breaks at ${round(load, 4)} kN</span>`);
    const stretch = this.run.elasticAt ? [`<span class="ghost-edge edge">with elastic lines</span>`] : [];
    $("legend").innerHTML = [...lines, ...loads, ...stretch].join(" ");
  }

  jump(t) {
    this.playback.pause();
    this.playback.seek(t);
  }

  restore({ values, water }) {
    this.state.set({ values: { ...values }, water });
    this.link.write({ now: true });
  }

  setHover(hover) {
    this.hover = hover;
    this.drawMoment();
  }

  drawAll() {
    if (!this.run) return;
    this.charts.draw(this.run, this.run.window);
    this.playbackControls.draw();
    this.pins.show();
    this.showChoices();
    this.#legend();
    this.drawMoment();
  }

  drawMoment() {
    if (this.run) this.moment.request();
  }

  #paintMoment() {
    const { run } = this;
    const read = run.nearest(this.hover?.t ?? this.state.t);
    this.instants.follow(run, { case: run.ofCase, whole: !run.preview }, read);
    this.sceneView.draw();
    this.charts.cursor(run.nearest(this.state.t), this.hover);
    this.playbackControls.show();
  }

  /** Opens the case file of a structure; one of the thesis's model opens the other page. */
  async open(file) {
    const { structure, values } = await fetchCase(file);
    const address = structure ? await keepStructure(file) : `index.html#${caseFragment(values)}`;
    // The address is that of another case from now on.
    this.link.held = true;
    location.href = address;
  }

  /** Follows the history to another case, which loads the page again. */
  travel() {
    this.controls.endTyping();
    const { identity, schema } = this.state;
    const own = schema.start && identityOf(schema.start);
    // An address that names no case is of the one with which the program was started.
    const named = caseOfFragment(location.hash.slice(1)) ?? own ?? identity;
    this.link.held = named !== identity && (named === own || keptStructure(named) !== null);
    if (this.link.held) location.reload();
    return !this.link.held;
  }

  tools() {
    themeButton(() => this.drawAll());
    acceptCaseFiles((file) => this.open(file));
    purposeAndSkip(PURPOSE_READ);
    $("file").textContent = this.state.caseName;
    $("elastic").addEventListener("change", () => this.state.set({ elastic: $("elastic").checked }));
    $("waters").addEventListener("change", (event) => {
      this.state.set({ ...this.state.ofWater(event.target.value), window: null });
      this.link.write({ now: true });
    });
    $("zoom-all").addEventListener("click", () => this.state.set({ window: null }));
    $("events-body").addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row) this.jump(Number(row.dataset.t));
    });
  }
}

const keyOf = (value) => JSON.stringify(value);

try {
  const schema = await fetchStructures();
  const named = caseOfFragment(location.hash.slice(1));
  const own = schema.start && named === identityOf(schema.start);
  const file = named === null || own ? null : keptStructure(named);
  const opened = file ? await fetchStructureFile(file) : schema.start;
  if (opened) new Page(schema, opened, file);
  else note("No structure is open. Drop a case file here, or start the program with one: snapload explore docs/examples/cylinder.toml");
} catch (error) {
  note(`The page could not start: ${error.message}. Is snapload explore still running?`);
  throw error;
}
