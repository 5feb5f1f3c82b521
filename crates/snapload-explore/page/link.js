// The address follows the state, and the state follows the address.

/** Browsers limit how often a page rewrites its address. */
const PACE_MS = 350;
/** Changes of these fields make no entry in the history. */
const timeless = (fragment) => fragment.replace(/(^|&)t=[^&]*/, "");

export class Link {
  /**
   * `onBroken` receives what could not be read; `onTravel` is called before another entry of the history is read, and says
   * whether it is to be read.
   */
  constructor(state, { onBroken, onTravel }) {
    this.state = state;
    this.onBroken = onBroken;
    this.timer = null;
    this.held = false;
    this.written = "";
    this.gesture = null;
    addEventListener("popstate", () => {
      if (onTravel()) this.read();
    });
  }

  read() {
    const broken = this.state.readFragment(location.hash.slice(1));
    this.written = this.state.toFragment();
    // What changes from now on is an entry of its own.
    this.gesture = null;
    if (broken.length) this.onBroken(broken);
  }

  /**
   * Writes the state into the address soon, or now. It waits while a slider is dragged. Changes of one gesture make one
   * entry in the history; `sameEntry`: the change makes none.
   */
  write({ now = false, gesture = null, sameEntry = false } = {}) {
    if (now) this.#flush(gesture, sameEntry);
    else this.timer ??= setTimeout(() => this.#flush(), PACE_MS);
  }

  /** The address of the current state. */
  get address() {
    return `${location.origin}${location.pathname}#${this.state.toFragment()}`;
  }

  #flush(gesture = null, sameEntry = false) {
    clearTimeout(this.timer);
    this.timer = null;
    const fragment = this.state.toFragment();
    if (this.held || fragment === this.written) return;
    const goesOn = gesture !== null && gesture === this.gesture;
    const step = timeless(fragment) !== timeless(this.written) && !goesOn && !sameEntry;
    if (!sameEntry) this.gesture = gesture;
    if (step) history.pushState(null, "", `#${fragment}`);
    else history.replaceState(null, "", `#${fragment}`);
    this.written = fragment;
  }
}
