// What is asked of the server.

/** An answer that is an error: its message is that of the command, its key the one that is to be changed, if any. */
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

/** A longer wait than this is cut short by a newer question; a shorter one is worth its picture. */
const UNINTERRUPTED_MS = 120;

/** Runs, one at a time; of the questions that come meanwhile only the latest is asked. */
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
    // Never twice in a row: where every answer takes longer than that, one would see nothing while one drags.
    if (current.afterOneCutShort) return;
    const cutShort = () => {
      if (this.current === current && this.waiting) current.controller.abort();
    };
    setTimeout(cutShort, Math.max(current.startedAt + UNINTERRUPTED_MS - performance.now(), 0));
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

/** One run that is not dragged through. */
export async function fetchRun(question) {
  return (await post("api/run", question)).json();
}

/** The keys of a structure, and the one that the program was started with. */
export async function fetchStructures() {
  return (await fetch("api/structure")).json();
}

/** What the case file of a structure gives. */
export async function fetchStructureFile(file) {
  return (await post("api/structure", file)).json();
}

/** Work that takes long, and can be cancelled. */
export async function fetchLong(path, question, signal) {
  try {
    return await (await post(path, question, signal)).json();
  } catch (error) {
    throw error.name === "AbortError" ? error : readableError(error);
  }
}

/** The values that a case file gives. */
export async function fetchCase(file) {
  return (await post("api/case", file)).json();
}

/** What of a run is proved. */
export const fetchProof = (question, signal) => fetchLong("api/proof", question, signal);

/** The answer to a question about one case, in words and for programs. */
export const fetchAnswer = (name, question, signal) => fetchLong(`api/question/${name}`, question, signal);

/** Where a motion stands once a period, in the long run. */
export const fetchSection = (question, signal) => fetchLong("api/section", question, signal);

/** A refusal says why; whatever else goes wrong on the way means that nobody answers. */
function readableError(error) {
  return error instanceof Refused
    ? error
    : new Error("the program does not answer. Is snapload explore still running?");
}

/** A map line by line as it is computed; ends early when the signal aborts. */
export async function* fetchMap(question, signal) {
  yield* linesOf(await post("api/map", question, signal));
}

/**
 * Work that takes its time and reports its progress: `onProgress` gets each line, { doing, percent }. Gives the
 * resulting text.
 * @param {string} path
 * @param {object} question
 * @param {AbortSignal} signal
 * @param {(progress: { doing: string, percent: number }) => void} onProgress
 */
export async function fetchWithProgress(path, question, signal, onProgress) {
  try {
    for await (const line of linesOf(await post(path, { ...question, told: true }, signal))) {
      if (line.error) throw new Refused(line.error.message, line.error.key);
      if (line.answer !== undefined) return line.answer;
      onProgress(line);
    }
  } catch (error) {
    throw error.name === "AbortError" ? error : readableError(error);
  }
  throw new Error("The answer is incomplete. Is snapload explore still running?");
}

/** The lines of an answer, each as it comes. */
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
  const response = await post(path, question);
  return response.blob();
}
