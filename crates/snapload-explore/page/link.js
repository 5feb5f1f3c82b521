// The address follows the state, and the state follows the address.

/** Browsers count how often a page rewrites its address. */
const PACE_MS = 350;
/** Time passes without being a step that one would go back to. */
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
   * Writes the state into the address soon, or now. While it is held, as by a slider that is dragged, it waits. What
   * belongs to one gesture is one step to go back.
   */
  write({ now = false, gesture = null } = {}) {
    if (now) this.#flush(gesture);
    else this.timer ??= setTimeout(() => this.#flush(), PACE_MS);
  }

  /** The address that holds everything as it is now. */
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
