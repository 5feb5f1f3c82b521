// The address follows the state, and the state follows the address.

/** Browsers limit how often a page rewrites its address. */
const PACE_MS = 350;
/** Changes of these fields make no entry in the history. */
const timeless = (fragment) => fragment.replace(/(^|&)t=[^&]*/, "");

export class Link {
  constructor(state, { onBroken }) {
    this.state = state;
    this.onBroken = onBroken;
    this.timer = null;
    this.held = false;
    this.written = "";
    this.gesture = null;
    addEventListener("popstate", () => this.read());
  }

  read() {
    const broken = this.state.readFragment(location.hash.slice(1));
    this.written = this.state.toFragment();
    if (broken.length) this.onBroken(broken);
  }

  /**
   * Writes the state into the address soon, or now. It waits while a slider is dragged. Changes of one gesture make one
   * entry in the history.
   */
  write({ now = false, gesture = null } = {}) {
    if (now) this.#flush(gesture);
    else this.timer ??= setTimeout(() => this.#flush(), PACE_MS);
  }

  /** The address of the current state. */
  get address() {
    return `${location.origin}${location.pathname}#${this.state.toFragment()}`;
  }

  #flush(gesture = null) {
    clearTimeout(this.timer);
    this.timer = null;
    const fragment = this.state.toFragment();
    if (this.held || fragment === this.written) return;
    const goesOn = gesture !== null && gesture === this.gesture;
    const step = timeless(fragment) !== timeless(this.written) && !goesOn;
    this.gesture = gesture;
    if (step) history.pushState(null, "", `#${fragment}`);
    else history.replaceState(null, "", `#${fragment}`);
    this.written = fragment;
  }
}
