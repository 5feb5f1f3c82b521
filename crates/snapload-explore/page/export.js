// Exports: files as the command writes them, the scene, the animation, and lines to copy.

import { fetchFile, fetchWithProgress } from "./api.js";
import { $, isWaiting, setWaiting } from "./dom.js";
import { AnimationRecording } from "./animation-recording.js";
import { paint, svg } from "./shapes.js";

/** Size of the scene as an exported picture [px], and its pixels per point. */
const SIZE = { width: 960, height: 676 };
const FINENESS = 2;
const MAY_MS = 4000;

export class ExportPanel {
  /**
   * `question` returns the current request to the server, under `path`; `currentRun` the run that is shown; `picture`
   * makes the shapes and the caption of a run at a time. Slow files report their progress.
   */
  constructor({ state, sceneView, currentRun, question, address, picture, path = "api/export", slowFiles = [] }) {
    this.state = state;
    this.sceneView = sceneView;
    this.currentRun = currentRun;
    this.question = question;
    this.picture = picture;
    this.path = path;
    this.address = address;
    this.recording = null;
    this.writing = null;
    for (const button of document.querySelectorAll("[data-file]")) {
      button.addEventListener("click", () => this.#try(() => this.#file(button)));
    }
    $("scene-svg").addEventListener("click", () => this.#try(() => this.#sceneSvg()));
    $("scene-png").addEventListener("click", () => this.#try(() => this.#scenePng()));
    $("animation").addEventListener("click", () => this.#try(() => this.#animation()));
    $("animation-cancel").addEventListener("click", () => this.recording?.cancel());
    this.slowFiles = slowFiles;
    if (slowFiles.length) $("file-cancel").addEventListener("click", () => this.writing?.abort());
    for (const [id, text] of [
      ["copy-shell", () => this.#run.shell],
      ["copy-python", () => this.#run.python],
      ["copy-link", address],
    ]) {
      $(id).addEventListener("click", () => this.#try(() => copy($(id), text())));
    }
  }

  setRun(run) {
    $("shell").textContent = run.shell;
    $("python").textContent = run.python;
  }

  /** Shows the message of an error; that of work that goes on stays. */
  async #try(action) {
    if (!document.querySelector(".export [aria-disabled]")) this.showMessage("");
    try {
      await action();
    } catch (error) {
      this.showMessage(error.message);
    }
  }

  showMessage(text) {
    $("export-message").textContent = text;
  }

  /** The file belongs to the current values, even if they change while it is written. */
  async #file(button) {
    if (isWaiting(button)) return;
    const name = button.dataset.file;
    const of = `${name} of ${this.state.caseName ?? "your own values"}`;
    setWaiting(button, true);
    this.showMessage(`${of}: writing`);
    try {
      const path = `${this.path}/${name}`;
      if (this.slowFiles.includes(name)) return await this.#slowFile(path, name, of);
      save(await fetchFile(path, this.question()), name);
    } finally {
      setWaiting(button, false);
    }
    this.showMessage(`${of} is saved.`);
  }

  /** A slow file; one at a time, as each uses all processors. */
  async #slowFile(path, name, of) {
    this.writing?.abort();
    const writing = (this.writing = new AbortController());
    $("file-cancel").hidden = $("file-progress").hidden = false;
    $("file-progress").value = 0;
    try {
      const text = await fetchWithProgress(path, this.question(), writing.signal, ({ doing, percent }) => {
        if (this.writing !== writing) return;
        $("file-progress").value = percent / 100;
        this.showMessage(`${of}: ${doing}, ${percent} %`);
      });
      save(new Blob([text]), name);
      this.showMessage(`${of} is saved.`);
    } catch (error) {
      if (error.name !== "AbortError") throw error;
      // If it was cancelled for the next file, the message already belongs to that one.
      if (this.writing === writing) this.showMessage(`${of} was cancelled.`);
    } finally {
      if (this.writing === writing) {
        this.writing = null;
        $("file-cancel").hidden = $("file-progress").hidden = true;
      }
    }
  }

  /** The run that is shown; there may be none yet. */
  get #run() {
    const run = this.currentRun();
    if (!run) throw new Error("Nothing is shown yet that could be saved.");
    return run;
  }

  #shapes(scheme) {
    return this.picture.shapes(this.#run, this.#run.nearest(this.state.t), this.sceneView.options(SIZE.width, SIZE.height, scheme));
  }

  #sceneSvg() {
    // An exported picture always has the light theme.
    const title = `${this.#run.shell}, t = ${this.#run.nearest(this.state.t)}`;
    save(
      new Blob([svg(this.#shapes("light"), SIZE.width, SIZE.height, title)], { type: "image/svg+xml" }),
      "scene.svg",
    );
    this.showMessage("scene.svg is saved.");
  }

  async #scenePng() {
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: SIZE.width * FINENESS, height: SIZE.height * FINENESS });
    const context = canvas.getContext("2d");
    context.scale(FINENESS, FINENESS);
    paint(context, [sheet("#fdfdfb"), ...this.#shapes("light")]);
    save(await new Promise((done) => canvas.toBlob(done, "image/png")), "scene.png");
    this.showMessage("scene.png is saved.");
  }

  async #animation() {
    if (this.recording) return;
    const run = this.#run;
    const [from, to] = run.interval(this.state.window);
    const recording = (this.recording = new AnimationRecording({
      run,
      picture: this.picture,
      from,
      to: Math.min(to, run.tEnd),
      options: { ...this.sceneView.options(SIZE.width, SIZE.height), playing: true },
      size: SIZE,
    }));
    setWaiting($("animation"), true);
    $("animation-cancel").hidden = $("animation-progress").hidden = false;
    try {
      const blob = await recording.record((part) => {
        $("animation-progress").value = part;
        this.showMessage(`run.webm: ${Math.floor(100 * part)} %`);
      });
      if (blob) save(blob, "run.webm");
      this.showMessage(blob ? "run.webm is saved." : "The animation was cancelled.");
    } finally {
      setWaiting($("animation"), false);
      $("animation-cancel").hidden = $("animation-progress").hidden = true;
      this.recording = null;
    }
  }
}

const sheet = (fill) => ({
  points: [
    [0, 0],
    [SIZE.width, 0],
    [SIZE.width, SIZE.height],
    [0, SIZE.height],
  ],
  closed: true,
  fill,
});

export function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), MAY_MS);
}

export async function copy(button, text) {
  const before = button.dataset.words ?? (button.dataset.words = button.textContent);
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    // If the page may not write to the clipboard, the text is shown to be copied by hand.
    prompt("Copy this:", text);
  }
  setTimeout(() => (button.textContent = before), 1600);
}
