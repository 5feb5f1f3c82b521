"""The table of results, as Markdown."""

from pathlib import Path

BEGIN = "<!-- measured by bench/peers/run: begin -->"
END = "<!-- measured by bench/peers/run: end -->"


def significant(value: float) -> str:
    """Two digits; whole numbers above 10."""
    return f"{value:,.0f}" if value >= 10.0 else f"{value:.2g}"


def cells(row: dict, snapload_cost: float | None, compared: int) -> list[str]:
    name = f"{row['tool']}, {row['way']}"
    if "left_out" in row:
        return [name, "left out", "", "", "", "", ""]
    cost = row["us_an_impact"]
    verdict = "right" if row["end_right"] else "wrong"
    if row["end_kind_right"] and not row["end_right"]:
        verdict = "wrong time"
    kind = row["end"]["kind"].replace("_", " ")
    return [
        f"{row['tool']} {row['version']}, {row['way']}",
        significant(cost),
        significant(cost / snapload_cost) if snapload_cost else "",
        f"{row['found']} / {row['missed']} / {row['invented']}",
        f"{min(row['right_up_to'], compared)}",
        f"{kind}: {verdict}",
        f"{row['end_time_error']:.0e}".replace("e-0", "e-").replace("e+00", ""),
    ]


def markdown(results: dict) -> str:
    reference = results["truth"]
    compared = reference["compared"]
    snapload_cost = next((r.get("us_an_impact") for r in results["peers"] if r["tool"] == "snapload"), None)
    head = [
        "the standard case in",
        "µs an impact",
        "times snapload",
        "impacts found / missed / invented",
        "right to 1e-6 up to impact",
        "end",
        "off by",
    ]
    rows = [head, ["---", *["---:"] * 4, "---", "---:"]]
    rows += [cells(row, snapload_cost, compared) for row in results["peers"]]
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    left_out = [r for r in results["peers"] if "left_out" in r]
    notes = [f"{row['tool']} is left out: {row['left_out']}." for row in left_out]
    source = (
        f"Measured {results['date']} on {results['machine']} (load {results['load']}); "
        f"of the {reference['impacts']} true impacts the first {compared} are compared, "
        "those that double precision can decide to 1e-6."
    )
    return "\n".join([*lines, "", " ".join([source, *notes])])


def into_readme(readme: Path, results: dict) -> None:
    """Puts the table between its markers."""
    before, rest = readme.read_text().split(BEGIN)
    _, after = rest.split(END)
    readme.write_text(f"{before}{BEGIN}\n{markdown(results)}\n{END}{after}")
