// A map as it is taken away: a table, and the command that computes it.

import { plain } from "./words.js";

/** The map as a table: a row a cell, empty where there is nothing. */
export function mapCsv({ x, y, xs, ys, ...cells }, columns) {
  const quoted = (value) => (/[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
  const rows = ys.flatMap((b, j) =>
    xs.map((a, i) => [a, b, ...columns.map((name) => cells[name][j * xs.length + i] ?? "")]),
  );
  const lines = [[x.key, y.key, ...columns], ...rows].map((row) => row.map((one) => quoted(String(one))).join(","));
  return new Blob([`${lines.join("\n")}\n`], { type: "text/csv" });
}

/** The command that computes the map, with all columns of a study. */
export function sweepLine({ map, values }) {
  const { x, y } = map;
  const held = Object.entries(values).filter(([name]) => name !== x.key && name !== y.key);
  const set = held.map(([name, value]) => `--set ${name}=${plain(value)}`);
  const vary = [x, y].map(({ key, low, high, count }) => `--vary ${key}=${plain(low)}:${plain(high)}:${count}`);
  return ["snapload sweep", ...set, ...vary, "--out map.parquet"].join(" ");
}
