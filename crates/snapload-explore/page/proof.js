// The seal of a run shows its proved part. It belongs to the current run and disappears with it.

import { fetchProof } from "./api.js";
import { $ } from "./dom.js";
import { number, withSymbols, sentence } from "./formatting.js";

/** A tick if the proof reaches the end, a bar if it does not. */
const SIGNS = { whole: "M4.6 8.3 7 10.7 11.5 5.6", part: "M4.8 8h6.4" };

export class Proof {
  constructor() {
    this.values = null;
    this.asking = null;
    $("prove").addEventListener("click", () => (this.asking ? this.#stop() : this.#ask()));
  }

  /** The values of the current run. */
  setValues(values) {
    const same = JSON.stringify(values) === JSON.stringify(this.values);
    this.values = values;
    if (same) return;
    this.#stop();
    $("seal").hidden = true;
    $("seal").open = false;
    $("prove").hidden = false;
    if (this.file) URL.revokeObjectURL(this.file);
    this.file = null;
  }

  #stop() {
    this.asking?.abort();
    this.asking = null;
    this.#showMessage("", "Prove");
  }

  async #ask() {
    const asking = (this.asking = new AbortController());
    this.#showMessage("Proving …", "Stop");
    let message = "";
    try {
      const proof = await fetchProof({ values: this.values }, asking.signal);
      if (this.asking === asking) this.#seal(proof);
    } catch (error) {
      message = `Not proved: ${error.message}`;
    }
    // A cancelled request has no message.
    if (this.asking !== asking) return;
    this.asking = null;
    this.#showMessage(message, "Prove");
  }

  #showMessage(message, button) {
    $("prove-message").textContent = message;
    $("prove").textContent = button;
  }

  #seal({ proved, t, leaves, words, further, certificate }) {
    const reach = proved ? "proved to the end" : `proved up to t = ${number(Number(t), 5)}`;
    // The page shows the run of doubles, which may depart from the proved one.
    const title = leaves === null ? reach : `${reach}; this run departs from the proof at impact ${leaves}`;
    $("seal").classList.toggle("whole", proved);
    $("seal-sign").setAttribute("d", proved ? SIGNS.whole : SIGNS.part);
    $("seal-title").textContent = title;
    $("seal-words").textContent = withSymbols(words).split("\n").map(sentence).join("\n");
    $("seal-further").hidden = !further;
    $("seal-further").querySelector("code").textContent = further ?? "";
    this.file = URL.createObjectURL(new Blob([certificate], { type: "application/json" }));
    $("seal-file").href = this.file;
    // After the button was pressed by keyboard, the focus moves to the seal.
    const focused = document.activeElement === $("prove");
    $("prove").hidden = true;
    $("seal").hidden = false;
    if (focused) $("seal").querySelector("summary").focus();
  }
}
