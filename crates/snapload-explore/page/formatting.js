// Numbers and symbols as text.

const MINUS = "\u2212";

/** A number with some significant digits, without trailing zeros; with a power of ten if very small or large. */
export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size < 1e-3 || size >= 1e6 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  const [mantissa, exponent] = (text.includes("e") ? text : String(Number(text))).split("e");
  const plain = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  return (exponent ? `${plain}e${Number(exponent)}` : plain).replaceAll("-", MINUS);
}

/** A number with a fixed number of decimals, for readings that must not change their width. */
export function fixed(value, decimals) {
  if (value === null || value === undefined) return "–";
  const text = value.toFixed(decimals);
  // What is rounded to zero has no sign.
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", MINUS);
}

/** A number with some digits as engineers write it: a large one as a whole number, without a power of ten. */
export const round = (value, digits = 3) => (Math.abs(value) >= 1000 ? fixed(value, 0) : number(value, digits));

/**
 * A utilisation or a safety factor, with two decimals; one next to 1 with as many as show on which side of 1 it is: the
 * rule of the texts of `snapload assess` (`ratio` in text_layout.rs of snapload-structure).
 */
export function ratio(value) {
  if (value === null || value === undefined) return "–";
  const decimals = [2, 3, 4, 5, 6].find((k) => (Number(value.toFixed(k)) < 1) === (value < 1));
  return fixed(value, decimals ?? 2);
}

/** A text within HTML, also within an attribute. */
export const escape = (text) =>
  text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

/** The text of a number field: all digits, in ASCII, so that it can be edited and sent. */
export function fieldText(value) {
  if (value === null || value === undefined) return "";
  if (Array.isArray(value)) return `[${value.map(fieldText).join(", ")}]`;
  return typeof value === "number" && value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential() : String(value);
}

/** A symbol of the schema as HTML: letters in italics, subscripts after an underscore. */
export function symbolHtml(symbol) {
  const [stem, below] = symbol.split("_");
  if (symbol.split("_").length > 2 || [...stem.normalize("NFC")].length > 2) return symbol;
  // A mark that has no letter of its own falls into it in italics of some fonts.
  const marked = [...stem.normalize("NFC")].length > 1 && /\p{M}$/u.test(stem.normalize("NFC"));
  const italic = marked ? `<i class="marked">${stem}</i>` : `<i>${stem}</i>`;
  return below ? `${italic}<sub>${below}</sub>` : italic;
}

/** Symbols in running text, such as those of the schema's meanings. */
export function withSymbols(text) {
  return text
    .replaceAll("omega", "Ω")
    .replaceAll("theta", "θ")
    .replaceAll("pi/2", "π/2")
    .replaceAll(/\bnu\b/g, "ν")
    .replaceAll("^2", "²")
    .replaceAll("v_n", "vₙ")
    .replaceAll("f_o", "fₒ")
    .replaceAll(" -e ", ` ${MINUS}e `);
}

export const unitText = (unit) => (unit === "1" ? "" : unit.replaceAll("^2", "²").replaceAll(" ", "\u2009"));

/** Marks what is read between the rows of a motion as approximate. */
export const about = (moment) => (moment.rough ? "about " : "");

const MODES = ["slack", "sliding", "rocking", "locked"];

/** The name of a mode; `taut` is null where it is not known which cables are taut. */
export function modeName(taut) {
  if (taut === null) return "mode not known";
  return MODES[Math.min(taut.length, MODES.length - 1)];
}

/** The text of a reason of the answers. */
export const reasonText = (reason) => reason.replaceAll("_", " ");

/** A text with a capital at the start and a full stop at the end. */
export function sentence(text) {
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  return begun.endsWith(".") ? begun : `${begun}.`;
}
