// The address follows the state, and the state follows the address.

/** Browsers count how often a page rewrites its address. */
const PACE_MS = 350;

export class Link {
  constructor(state, { onBroken }) {
    Object.assign(this, { state, onBroken, timer: null });
    addEventListener("popstate", () => this.read());
  }

  read() {
    const broken = this.state.takeFragment(location.hash.slice(1));
    if (broken.length) this.onBroken(broken);
  }

  /** Writes the state into the address soon: as a step of its own to go back from, or over the latest one. */
  write({ step = false } = {}) {
    if (step) {
      this.#flush();
      const fragment = `#${this.state.toFragment()}`;
      if (fragment !== location.hash) history.pushState(null, "", fragment);
      return;
    }
    this.timer ??= setTimeout(() => this.#flush(), PACE_MS);
  }

  /** The address that holds everything as it is now. */
  get address() {
    return `${location.origin}${location.pathname}#${this.state.toFragment()}`;
  }

  #flush() {
    if (this.timer === null) return;
    clearTimeout(this.timer);
    this.timer = null;
    history.replaceState(null, "", `#${this.state.toFragment()}`);
  }
}
