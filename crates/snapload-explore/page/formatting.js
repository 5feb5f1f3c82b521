// Numbers and symbols as they are read.

const MINUS = "\u2212";

/** A number with so many significant digits, without idle zeros; powers of ten where it is very small or large. */
export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size < 1e-3 || size >= 1e6 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  const [mantissa, exponent] = (text.includes("e") ? text : String(Number(text))).split("e");
  const plain = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  return (exponent ? `${plain}e${Number(exponent)}` : plain).replaceAll("-", MINUS);
}

/** A number with so many decimals, for readings that must not jump about. */
export function fixed(value, decimals) {
  return value === null || value === undefined ? "–" : value.toFixed(decimals).replace("-", MINUS);
}

/** A number of so many digits as engineers write it: a large one to its unit, without a power of ten. */
export const round = (value, digits = 3) => (Math.abs(value) >= 1000 ? fixed(value, 0) : number(value, digits));

/** What a number field holds: every digit, and ASCII, so that it can be typed and sent. */
export function fieldText(value) {
  if (value === null || value === undefined) return "";
  return typeof value === "number" && value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential() : String(value);
}

/** A symbol of the schema as HTML: letters in italics, what follows an underscore below the line. */
export function symbolHtml(symbol) {
  const [stem, below] = symbol.split("_");
  if (symbol.split("_").length > 2 || [...stem.normalize("NFC")].length > 2) return symbol;
  const italic = `<i>${stem}</i>`;
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

const MODES = ["slack", "sliding", "rocking", "locked"];

export function modeName(taut) {
  return MODES[Math.min(taut.length, MODES.length - 1)];
}

/** What the answers call a reason, in words. */
export const reasonText = (reason) => reason.replaceAll("_", " ");

/** Words that begin large and end with a point. */
export function sentence(text) {
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  return begun.endsWith(".") ? begun : `${begun}.`;
}
