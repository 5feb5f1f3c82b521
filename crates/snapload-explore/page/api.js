// Requests to the server.

/** An error answer: its message is that of the command, its key the one to be changed, if any. */
export class Refused extends Error {
  constructor(message, key = null) {
    super(message);
    this.key = key;
  }
}

async function post(path, body, signal) {
  const response = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
    signal,
  });
  if (response.ok) return response;
  const { key, message } = await response.json().catch(() => ({}));
  throw new Refused(message ?? `the server answered with status ${response.status}`, key);
}

export async function fetchSchema() {
  const response = await fetch("api/schema");
  if (!response.ok) throw new Refused(`the server answered with status ${response.status}`);
  return response.json();
}

/** A newer request cancels a run that takes longer than this; a shorter run is finished and drawn. */
const UNINTERRUPTED_MS = 120;

/** Runs, one at a time; of the requests that arrive meanwhile only the latest is sent. */
export class Runner {
  constructor({ onAnswer, onError, path = "api/run" }) {
    this.onAnswer = onAnswer;
    this.onError = onError;
    this.path = path;
    this.current = null;
    this.waiting = null;
  }

  ask(question, since) {
    this.waiting = { question, since };
    const { current } = this;
    if (!current) return this.#next();
    // Never twice in a row: if every answer takes longer, nothing would be drawn during a drag.
    if (current.afterOneCutShort) return;
    const cutShort = () => {
      if (this.current === current && this.waiting) current.controller.abort();
    };
    setTimeout(cutShort, Math.max(current.startedAt + UNINTERRUPTED_MS - performance.now(), 0));
  }

  /** Asks for what is shown in place of a refused question, unless a newer one waits. */
  askInstead(question, since) {
    if (!this.waiting) this.ask(question, since);
  }

  async #next(afterOneCutShort = false) {
    const { question, since } = this.waiting;
    const controller = new AbortController();
    this.waiting = null;
    this.current = { controller, startedAt: performance.now(), afterOneCutShort };
    let answer = null;
    try {
      answer = await (await post(this.path, question, controller.signal)).json();
    } catch (error) {
      if (error.name !== "AbortError") this.onError(readableError(error), question);
    }
    this.current = null;
    if (this.waiting) this.#next(controller.signal.aborted);
    if (answer) this.onAnswer(answer, since, question);
  }
}

/** A single run. */
export async function fetchRun(question) {
  return (await post("api/run", question)).json();
}

/** The keys of a structure, and the one that the program was started with. */
export async function fetchStructures() {
  return (await fetch("api/structure")).json();
}

/** The values of a structure's case file. */
export async function fetchStructureFile(file) {
  return answered(async () => (await post("api/structure", file)).json());
}

/** A long request that can be cancelled. */
export async function fetchLong(path, question, signal) {
  return answered(async () => (await post(path, question, signal)).json());
}

/** The values of a case file. */
export async function fetchCase(file) {
  return answered(async () => (await post("api/case", file)).json());
}

/** How a run and its neighbours end. */
export const fetchOutcome = (question, signal) => fetchLong("api/outcome", question, signal);

/** The proved part of a run. */
export const fetchProof = (question, signal) => fetchLong("api/proof", question, signal);

/** The answer to a question about one case, as text and as JSON. */
export const fetchAnswer = (name, question, signal) => fetchLong(`api/question/${name}`, question, signal);

/** The state once a period, over a long motion. */
export const fetchSection = (question, signal) => fetchLong("api/section", question, signal);

/** What a request results in; its error says what is wrong. */
async function answered(request) {
  try {
    return await request();
  } catch (error) {
    throw readableError(error);
  }
}

/** A refusal has its own message, and a cancelled request none; any other failure means that the server does not answer. */
function readableError(error) {
  return error instanceof Refused || error.name === "AbortError"
    ? error
    : new Error("the program does not answer. Is snapload explore still running?");
}

/** A map line by line as it is computed; ends early when the signal aborts. */
export async function* fetchMap(question, signal) {
  yield* linesOf(await post("api/map", question, signal));
}

/**
 * A long request that reports its progress: `onProgress` receives each line, { doing, percent }. Returns the resulting
 * text.
 * @param {string} path
 * @param {object} question
 * @param {AbortSignal} signal
 * @param {(progress: { doing: string, percent: number }) => void} onProgress
 */
export async function fetchWithProgress(path, question, signal, onProgress) {
  try {
    for await (const line of linesOf(await post(path, { ...question, progress: true }, signal))) {
      if (line.error) throw new Refused(line.error.message, line.error.key);
      if (line.answer !== undefined) return line.answer;
      onProgress(line);
    }
  } catch (error) {
    throw readableError(error);
  }
  throw new Error("The answer is incomplete. Is snapload explore still running?");
}

/** The lines of an answer, each as it arrives. */
async function* linesOf(response) {
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) break;
    const lines = (rest + value).split("\n");
    rest = lines.pop();
    for (const line of lines) if (line) yield JSON.parse(line);
  }
  if (rest.trim()) yield JSON.parse(rest);
}

/** A file as the command writes it. */
export async function fetchFile(path, question) {
  return answered(async () => (await post(path, question)).blob());
}
