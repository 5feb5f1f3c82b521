// Colours are named in theme.css alone; whoever paints on a canvas asks for them here.

/** The names that theme.css gives, without their dashes: those whose values are colours. */
function names() {
  const sheet = [...document.styleSheets].find(({ href }) => href?.endsWith("/theme.css"));
  const root = /** @type {CSSStyleRule} */ (sheet?.cssRules[0]);
  const all = root ? [...root.style].filter((name) => name.startsWith("--")) : [];
  return all.filter((name) => CSS.supports("color", root.style.getPropertyValue(name))).map((name) => name.slice(2));
}

const caches = new Map();

/** All colours of the scheme in effect, or of the one named. */
export function colours(scheme = "") {
  const known = caches.get(scheme);
  if (known) return known;
  const probe = document.createElement("span");
  probe.hidden = true;
  // Where the system chooses the page's few colours, pictures keep their own.
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

/** Lines have colours of their own, up to six; more begin again. */
export const lineColour = (paints, line) => paints[`cable-${((line - 1) % 6) + 1}`];

/** What an end of a run is painted with; one without a colour of its own is another limit. */
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

/** What the browser keeps for the page under a name; it may keep nothing for us. */
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
    // It then lasts as long as the page.
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

export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
