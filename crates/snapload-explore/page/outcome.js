// How the neighbours of a run end. They are run once the values rest, as they take longer than the run.

import { fetchOutcome } from "./api.js";
import { $, setProperties } from "./dom.js";
import { sentence, withSymbols } from "./formatting.js";

/** The values rest if they have not changed for this long. */
const REST_MS = 300;

export class Outcome {
  /** Takes a run and its values; without neighbours, if it is certain how it ends, the run itself has the text. */
  setRun(run, values) {
    const key = JSON.stringify(values);
    if (key === this.key) return;
    this.key = key;
    clearTimeout(this.resting);
    this.asking?.abort();
    this.#show(run.outcome ?? "neighbours to come");
    if (run.outcome === null) this.resting = setTimeout(() => this.#ask(values), REST_MS);
  }

  async #ask(values) {
    const asking = (this.asking = new AbortController());
    let words;
    try {
      ({ words } = await fetchOutcome({ values }, asking.signal));
    } catch (error) {
      words = `not known: ${error.message}`;
    }
    if (!asking.signal.aborted) this.#show(words);
  }

  #show(words) {
    const textContent = sentence(`Outcome: ${withSymbols(words).replaceAll("\n", ", ")}`);
    setProperties($("outcome"), { textContent });
  }
}
