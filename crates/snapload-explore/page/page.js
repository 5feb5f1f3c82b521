// The parts that every page has: a note, the theme, opened files, and the time of a picture.

import { fetchStructureFile } from "./api.js";
import { $ } from "./dom.js";
import { identityOf } from "./structure-state.js";
import { chooseTheme, chosenTheme, store, stored, onPrint, onSystemScheme, THEMES } from "./theme.js";

/** Shows a note about the page as a whole; hides it if the text is empty. */
export function note(text) {
  $("note").textContent = text;
  $("note").hidden = !text;
}

/** Reports the time from an event to the picture of its result, and then calls `then`. */
export function reportPaintTime(since, then = () => {}) {
  requestAnimationFrame(() => {
    // This runs after the frame is painted.
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

/** The button of the theme; `redraw` follows a change of it, and of the colours on paper. */
export function themeButton(redraw) {
  const show = () => ($("theme").textContent = `Theme: ${chosenTheme()}`);
  $("theme").addEventListener("click", () => {
    chooseTheme(THEMES[(THEMES.indexOf(chosenTheme()) + 1) % THEMES.length]);
    show();
    redraw();
  });
  show();
  onSystemScheme(redraw);
  onPrint(redraw);
}

/** The line about the page's purpose, which stays closed under a name once it is closed; and the link to the scene. */
export function purposeAndSkip(name) {
  $("purpose").hidden = stored(name) === "yes";
  $("purpose-close").addEventListener("click", () => {
    $("purpose").hidden = true;
    $("scene").focus({ preventScroll: true });
    store(name, "yes");
  });
  // The address holds the state: a link within the page must not change it.
  $("skip").addEventListener("click", (event) => {
    event.preventDefault();
    $("scene").focus();
  });
}

/** The case files of structures that were opened last, kept until the window is closed: each with what an address calls it. */
const OPENED = "snapload-structures";
const MOST_OPENED = 12;
const opened = () => JSON.parse(sessionStorage.getItem(OPENED) ?? "[]");
export const keptStructure = (identity) => opened().find(([of]) => of === identity)?.[1] ?? null;

/** Keeps a file, and returns its address on the page of structures; a file that is no structure is refused here. */
export async function keepStructure(file) {
  const identity = identityOf(await fetchStructureFile(file));
  const others = opened().filter(([of]) => of !== identity);
  sessionStorage.setItem(OPENED, JSON.stringify([[identity, file], ...others].slice(0, MOST_OPENED)));
  return `structure.html#case=${encodeURIComponent(identity)}`;
}

/** Values of the thesis's model as a fragment of its page's address. */
export const caseFragment = (values) =>
  Object.entries(values)
    .map(([name, value]) => `${name}=${encodeURIComponent(value)}`)
    .join("&");

/** Opens a case file by the button or by dropping it on the page, and shows its errors. */
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
