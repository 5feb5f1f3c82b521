// Keyboard shortcuts: one table, which the help shows, too.

import { $ } from "./dom.js";

/**
 * Keys, their labels, their descriptions and their actions.
 * @returns {[string[], string, string, ((event: KeyboardEvent) => void) | null][]}
 */
function keyTable({ playback, playbackControls, state, map, pins }) {
  const toggle = (name, one, other) => state.set({ [name]: state[name] === one ? other : one, zoom: null });
  return [
    ...timeKeys({ playback, playbackControls }),
    [["v"], "v", "real picture, or that of the thesis", () => toggle("picture", "real", "thesis")],
    [["c"], "c", "whole scene, or close to the body", () => toggle("view", "whole", "close")],
    [["g"], "g", "ghost on or off", () => $("ghost").click()],
    [["l"], "l", "loop on or off", () => state.set({ loop: !state.loop })],
    [["p"], "p", "pin this run", () => pins.add()],
    [["m"], "m", "map open or closed", () => map.toggle()],
    [["?"], "?", "this help", () => $("help").click()],
  ];
}

/**
 * The shortcuts of playback, which every page has.
 * @returns {[string[], string, string, ((event: KeyboardEvent) => void) | null][]}
 */
export function timeKeys({ playback, playbackControls }) {
  return [
    [[" "], "space", "play or pause", () => playback.toggle()],
    [["ArrowRight"], "→", "next event", (event) => (event.shiftKey ? playback.fine(1) : playback.next())],
    [["ArrowLeft"], "←", "previous event", (event) => (event.shiftKey ? playback.fine(-1) : playback.previous())],
    [[], "shift + → ←", "a small step of time", null],
    [["Home"], "Home", "to the start", () => playbackControls.jump(playbackControls.ends[0])],
    [["End"], "End", "to the end", () => playbackControls.jump(playbackControls.ends[1])],
    [["+", "="], "+", "faster", () => playback.faster(1)],
    [["-", "_"], "−", "slower", () => playback.faster(-1)],
    [["["], "[", "zoom in on the time cursor", () => playbackControls.zoom(0.5)],
    [["]"], "]", "zoom out", () => playbackControls.zoom(2)],
  ];
}

/** Elements that need certain keys themselves. */
function needed(target, key) {
  if (target.matches("input[type=range]")) return /^(Arrow|Home|End|Page)/.test(key);
  if (target.matches("input[type=checkbox], button, summary, a")) return key === " " || key === "Enter";
  if (target.matches("input[type=radio]")) return key === " " || key.startsWith("Arrow");
  return target.matches("input, select, textarea");
}

export class Keyboard {
  /** `table` has the shortcuts of a page, in the form of `keyTable`. */
  constructor(parts, table = keyTable(parts)) {
    const dialog = $("help-dialog");
    $("help-keys").innerHTML = table
      .map(([, shown, words]) => `<dt><kbd>${shown}</kbd></dt><dd>${words}</dd>`)
      .join("");
    $("help").addEventListener("click", () => dialog.showModal());
    $("help-close").addEventListener("click", () => dialog.close());
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented || dialog.open) return;
      const single = event.key.length === 1 && event.key !== " ";
      if (single && !$("single-keys").checked) return;
      const stepping = event.target === $("scrub") && /^Arrow(Left|Right)$|^Home$|^End$/.test(event.key);
      if (!stepping && needed(event.target, event.key)) return;
      const entry = table.find(([keys]) => keys.includes(event.key));
      if (!entry || !parts.playback.run) return;
      event.preventDefault();
      entry[3](event);
    });
  }
}
