// The colours of theme.css, for painting on a canvas.

/** The names of the colours in theme.css, without their dashes. */
function names() {
  const sheet = [...document.styleSheets].find(({ href }) => href?.endsWith("/theme.css"));
  const root = /** @type {CSSStyleRule} */ (sheet?.cssRules[0]);
  const all = root ? [...root.style].filter((name) => name.startsWith("--")) : [];
  return all.filter((name) => CSS.supports("color", root.style.getPropertyValue(name))).map((name) => name.slice(2));
}

const caches = new Map();

/** Whether the page is being printed: on white paper, as no browser prints a dark background unasked. */
let printing = false;
export const isPrinting = () => printing;

/** All colours of the current scheme, which is light on paper, or of the named one. */
export function colours(scheme = printing ? "light" : "") {
  const known = caches.get(scheme);
  if (known) return known;
  const probe = document.createElement("span");
  probe.hidden = true;
  // If the system chooses the page's colours, pictures keep their own.
  probe.style.forcedColorAdjust = "none";
  if (scheme) probe.style.colorScheme = scheme;
  document.body.append(probe);
  const found = {};
  for (const name of names()) {
    probe.style.color = `var(--${name})`;
    found[name] = getComputedStyle(probe).color;
  }
  probe.remove();
  caches.set(scheme, found);
  return found;
}

/** The colour of a line; after six lines the colours repeat. */
export const lineColour = (paints, line) => paints[`cable-${((line - 1) % 6) + 1}`];

/** The colour of an end of a run; ends without a colour of their own are other limits. */
export const endColour = (paints, reason) => paints[`end-${reason}`] ?? paints["end-other"];

/** Between two colours: `part` of the way from the first to the second. */
export function mix(from, to, part) {
  const channels = (colour) =>
    colour
      .match(/[\d.]+/g)
      .slice(0, 3)
      .map(Number);
  const [a, b] = [channels(from), channels(to)];
  const k = Math.min(Math.max(part, 0), 1);
  return `rgb(${a.map((v, i) => Math.round(v + (b[i] - v) * k)).join(" ")})`;
}

const KEY = "snapload-theme";
export const THEMES = ["auto", "light", "dark"];

/** A value that the browser stores for the page under a name; storage may be disabled. */
export function stored(name) {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

export function store(name, value) {
  try {
    localStorage.setItem(name, value);
  } catch {
    // The choice then lasts until the page is closed.
  }
}

/** The theme that was chosen before; `auto` follows the system. */
export function chosenTheme() {
  const theme = stored(KEY);
  return THEMES.includes(theme) ? theme : "auto";
}

export function chooseTheme(theme) {
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  caches.clear();
  store(KEY, theme);
}

/** Calls back when the system's scheme changes. */
export function onSystemScheme(listener) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    caches.clear();
    listener();
  });
}

/** Calls back before the page is printed, and after. */
export function onPrint(listener) {
  const change = (now) => {
    printing = now;
    listener();
  };
  addEventListener("beforeprint", () => change(true));
  addEventListener("afterprint", () => change(false));
}

export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
