// Exports of a map: a table, and the command that computes it.

import { fieldText } from "./formatting.js";

/** The map as a table: one row per cell, with empty entries where there is no value. */
export function mapCsv({ x, y, xs, ys, ...cells }, columns) {
  const quoted = (value) => (/[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
  const rows = ys.flatMap((b, j) =>
    xs.map((a, i) => [a, b, ...columns.map((name) => cells[name][j * xs.length + i] ?? "")]),
  );
  const lines = [[x.key, y.key, ...columns], ...rows].map((row) => row.map((one) => quoted(String(one))).join(","));
  return new Blob([`${lines.join("\n")}\n`], { type: "text/csv" });
}

/** The command that computes the map, with all columns of a study. */
export const sweepLine = ({ map, values }) => studyLine("sweep", values, [map.x, map.y], "--out map.parquet");

/** The command of a study over some axes, with the values of the other keys, and further options. */
export function studyLine(verb, values, axes, more) {
  const held = Object.entries(values).filter(([name]) => !axes.some(({ key }) => key === name));
  const set = held.map(([name, value]) => `--set ${name}=${fieldText(value)}`);
  const vary = axes.map((axis) => `--vary ${rangeText(axis)}`);
  return [`snapload ${verb}`, ...set, ...vary, more].join(" ");
}

/** The values of an axis in the notation of the command. */
export const rangeText = ({ key, low, high, count }) => `${key}=${fieldText(low)}:${fieldText(high)}:${count}`;
