// What every page has around its content: a note, the theme, files that are opened, and how long a picture took.

import { fetchStructureFile } from "./api.js";
import { $ } from "./dom.js";
import { chooseTheme, chosenTheme, store, stored, onSystemScheme, THEMES } from "./theme.js";

/** Says something of the page as a whole; with no text, that there is nothing to say. */
export function note(text) {
  $("note").textContent = text;
  $("note").hidden = !text;
}

/** Says how long it took from an event to the picture that follows from it, and goes on with what can wait for that. */
export function reportPaintTime(since, then = () => {}) {
  requestAnimationFrame(() => {
    // After the frame's paint, and not before it.
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      const took = performance.now() - since;
      $("took").textContent = `picture in ${Math.round(took)} ms`;
      $("took").dataset.ms = took.toFixed(2);
      $("took").dataset.count = Number($("took").dataset.count ?? 0) + 1;
      then();
    };
    channel.port2.postMessage(null);
  });
}

/** The button of the theme; `redraw` follows a change of it. */
export function themeButton(redraw) {
  const show = () => ($("theme").textContent = `Theme: ${chosenTheme()}`);
  $("theme").addEventListener("click", () => {
    chooseTheme(THEMES[(THEMES.indexOf(chosenTheme()) + 1) % THEMES.length]);
    show();
    redraw();
  });
  show();
  onSystemScheme(redraw);
}

/** The line of purpose, closed for good under a name; and the link to the scene. */
export function purposeAndSkip(name) {
  $("purpose").hidden = stored(name) === "yes";
  $("purpose-close").addEventListener("click", () => {
    $("purpose").hidden = true;
    store(name, "yes");
  });
  // The address belongs to the state: a link within the page must not write into it.
  $("skip").addEventListener("click", (event) => {
    event.preventDefault();
    $("scene").focus();
  });
}

/** The case file of a structure is kept as long as the window is, for the page of structures. */
const OPENED = "snapload-structure";
export const openedStructure = () => JSON.parse(sessionStorage.getItem(OPENED) ?? "null");

/** Goes there with a file; one that can not be a structure is refused here, where it was opened. */
export async function openStructure(file) {
  await fetchStructureFile(file);
  sessionStorage.setItem(OPENED, JSON.stringify(file));
  location.href = "structure.html";
}

/** A case file is opened by its button, or by dropping it anywhere. What is wrong with it is said. */
export function acceptCaseFiles(onFile) {
  const open = async (file) => {
    if (!file) return;
    try {
      await onFile({ name: file.name, text: await file.text() });
    } catch (error) {
      note(error.message);
    }
  };
  $("open-case").addEventListener("change", () => {
    open($("open-case").files[0]);
    $("open-case").value = "";
  });
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    open(event.dataTransfer.files[0]);
  });
}
