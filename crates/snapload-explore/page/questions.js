// All questions about one case that the program answers, with their options.

import { fetchAnswer } from "./api.js";
import { $ } from "./dom.js";
import { CancellableRequest } from "./long-run.js";
import { finite } from "./state.js";
import { fieldText, withSymbols, sentence, unitText } from "./formatting.js";

export class Questions {
  /** @param {{ name: string, asks: string, options: any[] }[]} questions @param {{ values: () => object }} page */
  constructor(questions, page) {
    this.questions = questions;
    $("question").replaceChildren(...questions.map(({ name }) => new Option(name, name)));
    $("question").addEventListener("change", () => this.#choose());
    this.asking = new CancellableRequest("question-ask", "question-message", async (signal) => {
      this.#show("");
      const asked = { values: page.values(), options: this.#options() };
      const { words } = await fetchAnswer(this.chosen.name, asked, signal);
      if (!signal.aborted) this.#show(words);
      return "";
    });
    this.#choose();
  }

  /** Takes changed values: the results that are shown do not belong to them. */
  setValues(values) {
    const key = JSON.stringify(values);
    if (key === this.key) return;
    this.key = key;
    this.asking.stop();
    this.#show("");
  }

  #choose() {
    this.asking.stop();
    this.#show("");
    this.chosen = this.questions.find(({ name }) => name === $("question").value);
    $("question-asks").textContent = sentence(withSymbols(this.chosen.asks));
    this.fields = this.chosen.options.map(field);
    $("question-options").replaceChildren(...this.fields.map(({ label }) => label));
  }

  #options() {
    return Object.fromEntries(this.fields.map(({ name, value }) => [name, value()]));
  }

  #show(words) {
    $("question-words").textContent = words.trimEnd();
    $("question-words").hidden = !words;
  }
}

/** The field of an option, and how its value is read. Invalid text is sent as it is: the program explains the error. */
function field({ name, unit, meaning, kind, default: usual }) {
  const label = document.createElement("label");
  label.title = withSymbols(meaning);
  label.append(`${name.replaceAll("_", " ")}${unitText(unit) && ` [${unitText(unit)}]`} `);
  /** @type {any} */
  const input = document.createElement(kind.type === "choice" ? "select" : "input");
  input.id = `question-${name}`;
  label.append(input);
  if (kind.type === "flag") {
    Object.assign(input, { type: "checkbox", checked: usual === true });
    return { name, label, value: () => input.checked };
  }
  if (kind.type === "choice") input.append(...kind.options.map((word) => new Option(word, word)));
  else input.className = "field";
  input.value = fieldText(usual);
  const isNumber = kind.type === "number" || kind.type === "count";
  return { name, label, value: () => (isNumber ? typed(input.value.trim()) : input.value || null) };
}

/** A number, the text if it is none, or null for nothing. */
function typed(text) {
  return text === "" ? null : (finite(text) ?? text);
}
