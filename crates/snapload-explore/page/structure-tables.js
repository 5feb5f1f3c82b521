// The answer in tables, as in `snapload assess` and its page: lines, checks, warnings, and the hardest snaps.

import { $, replaceButtons } from "./dom.js";
import { escape, fixed, number, ratio, round, sentence } from "./formatting.js";

/** The heading of slack; the tensions and snaps beside it are those of the judged time. */
const SLACK = "Slack of<br>all time";
/** The same of a run on elastic lines, which may have ended before the record. */
const elasticSlack = ({ end }, lasts_s) => (end.t_s < lasts_s ? `Slack to<br>${round(end.t_s)} s` : SLACK);

const kilo = (newtons) => (newtons === null || newtons === undefined ? "–" : round(newtons / 1e3, 4));
const percent = (part) => (part === null ? "–" : fixed(100 * part, 1));
const cell = (text, kind = "num") => `<td class="${kind}">${text}</td>`;

/** A utilisation as a bar, which is full if the line breaks. */
function bar(utilisation) {
  if (utilisation === null) return "not known";
  const part = Math.min(utilisation, 1);
  const kind = utilisation >= 1 ? "breaks" : "holds";
  return `<span class="meter ${kind}"><i style="width:${(100 * part).toFixed(1)}%"></i></span> ${ratio(utilisation)}`;
}

function lineRow(line, elastic) {
  const elasticCell = (text) => (elastic ? cell(text(elastic), "num stretch") : "");
  return (
    `<tr><th scope="row"><span class="c${((line.line - 1) % 6) + 1}">${line.line}</span></th>` +
    cell(bar(line.utilisation), "utilised") +
    cell(ratio(line.safety_factor), "num factor") +
    cell(kilo(line.breaking_load_n)) +
    cell(kilo(line.held_tension_n)) +
    cell(kilo(line.peak_tension_n)) +
    elasticCell(({ peak_n }) => kilo(peak_n)) +
    cell(percent(line.slack_fraction)) +
    elasticCell(({ slack_fraction }) => percent(slack_fraction)) +
    cell(line.snaps ? fixed(line.fastest_snap_m_s, 2) : "–") +
    cell(line.snaps === null ? "–" : String(line.snaps)) +
    cell(kilo(line.rest_tension_n)) +
    cell(kilo(line.least_tension_n)) +
    "</tr>"
  );
}

/** The lines, inextensible and, if computed, elastic side by side. */
export function showLines(run) {
  const elastic = run.elastic?.elastic;
  const head = (words, unit, kind = "num") =>
    `<th scope="col" class="${kind}">${words}${unit ? `<br><span>${unit}</span>` : ""}</th>`;
  const elasticHead = (words, unit) => (elastic ? head(`${words},<br>elastic`, unit, "num stretch") : "");
  $("lines").innerHTML =
    `<thead><tr><th scope="col">Line</th>${head("Utilisation", "", "")}${head("Safety<br>factor", "")}` +
    `${head("Breaking<br>load", "kN")}${head("While<br>taut", "kN")}${head("Snap<br>peak", "kN")}${elasticHead("Peak", "kN")}` +
    `${head(SLACK, "%")}${elastic ? elasticHead(elasticSlack(elastic, run.lasts_s), "%") : ""}${head("Fastest<br>snap", "m/s")}${head("Snaps", "")}` +
    `${head("At rest", "kN")}${head("Least", "kN")}</tr></thead><tbody>` +
    run.lines.map((line, i) => lineRow(line, elastic?.lines[i])).join("") +
    "</tbody>";
  const { end } = run.assessment;
  const names = [...new Set(run.lines.map(({ name }) => name))];
  const named = names.length === 1 && names[0] ? `Lines of ${names[0]}. ` : "";
  const nothing = run.lines.every(({ snaps }) => snaps === null) ? ", so that nothing is judged" : "";
  $("lines-words").textContent =
    `${named}The run ${end.reason}, ${round(end.t_s)} s; judged from ${round(run.transient_s)} s on${nothing}. While taut: the ` +
    "largest tension as long as a line stays taut; snap peak: estimated; slack: part of the whole time, the start that is not " +
    "judged included. Utilisation: the larger of these two tensions over the breaking load; the safety factor is its inverse, " +
    "and includes no factor of any rule." +
    (elastic ? " Elastic: the same with elastic lines, as computed by snapload elastic." : "");
  $("elastic-words").textContent = elastic ? elasticWords(elastic, run.assessment.warnings) : "";
}

/** The verdict of the run on elastic lines, how far it is known, and the warnings that the inextensible one lacks. */
function elasticWords({ verdict, trust, warnings }, others) {
  const heard = new Set(others.map(({ message }) => message));
  const own = warnings.filter(({ message }) => !heard.has(message)).map(({ message }) => sentence(message));
  return [`On elastic lines: ${verdict.words}`, trust.words, ...own].join(" ");
}

/** Checks by the rule of the case, other restitutions and waves, and warnings. */
export function showChecks(run) {
  const { checks, warnings } = run.assessment;
  const rows = checks.map((check) => {
    const of = check.line ? `line ${check.line}` : "body";
    const value = check.value === null ? "not known" : fixed(check.value, 3);
    return `<li class="${check.answer}"><b>${escape(check.answer_in_words)}</b> ${of}: ${escape(check.words)}
      ${number(check.limit)}: ${value}</li>`;
  });
  const others = [run.rebound, run.nearby_waves].filter((words) => words);
  const heard = others.map((words) => `<p class="small">${sentence(words)}</p>`).join("");
  $("checks").innerHTML = (rows.length ? `<h3>Design checks</h3><ul class="checks">${rows.join("")}</ul>` : "") + heard;
  const items = warnings.map(({ rule, message }) => `<li><b>${escape(rule)}</b>: ${escape(message)}</li>`);
  $("warnings").innerHTML = items.length ? `<h3>Warnings</h3><ul class="warnings">${items.join("")}</ul>` : "";
  $("summary").textContent = run.summary;
}

/** The hardest snaps; each row leads to its instant. */
export function showSnaps(run) {
  const { t, line, speed, peak, utilisation, jolt, hardest, all } = run.snaps;
  const before = hardest.filter((i) => t[i] < run.transient_s).length;
  const row = (i) =>
    `<tr data-t="${t[i]}"><td><button type="button" class="go" data-t="${t[i]}">${fixed(t[i], 3)}</button></td>` +
    `<td><span class="c${((line[i] - 1) % 6) + 1}">${line[i]}</span>${jolt[i] ? " impact while taut" : ""}</td>` +
    `${cell(fixed(speed[i], 3))}${cell(peak[i] === null ? "–" : round(peak[i], 4))}` +
    `${cell(ratio(utilisation[i]))}` +
    `<td>${t[i] < run.transient_s ? "no, in the transient" : "yes"}</td></tr>`;
  replaceButtons($("events-body"), hardest.map(row).join(""), $("scene"));
  const early = before ? `, and the ${before} hardest before it` : "";
  const listed = `the ${hardest.length - before} hardest in the judged time${early}, of ${run.snapsInWords} at 1 cm/s or more`;
  $("events-words").textContent = all ? listed : "no snaps at 1 cm/s or more";
}
