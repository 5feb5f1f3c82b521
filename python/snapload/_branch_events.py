"""The events along a branch, as a table."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from ._orbit_base import STATE, complex_array
from ._schema import units
from ._table import Table, numbers


def events_table(along: str, rows: list[dict[str, Any]]) -> Table:
    """One row for each event; `along` is the key that varies."""
    column, scales = partial(numbers, rows), units()

    largest = [np.abs(complex_array(row["multipliers"])).max() for row in rows]
    states = np.array([row["state"] for row in rows], dtype=np.float64).reshape(-1, len(STATE))
    cables = np.array([row["cable"] or 0 for row in rows], dtype=np.int64)
    admissible = np.array([row["admissible"] for row in rows], dtype=np.bool_)
    located = np.array([row["between"] is None for row in rows], dtype=np.bool_)
    return Table._from_columns(
        [
            ("kind", "", "kind of event", np.array([row["kind"] for row in rows], dtype=object)),
            ("value", scales[along] or "1", "value of the key", column("value")),
            ("arclength", "1", "length along the branch", column("arclength")),
            *((name, scales[name], f"{name} at the section", states[:, k]) for k, name in enumerate(STATE)),
            ("cable", "", "number of the cable, 0 for none", cables),
            ("t", scales["t"], "time in the lap", column("t")),
            (
                "normal_acceleration",
                scales["normal_acceleration"],
                "normal acceleration at a graze",
                column("normal_acceleration"),
            ),
            (
                "sqrt_coefficient",
                scales["sqrt_coefficient"],
                "velocity jump per square root of length",
                column("sqrt_coefficient"),
            ),
            ("largest_multiplier", "1", "largest |multiplier|", np.array(largest, dtype=np.float64)),
            ("admissible", "", "whether the orbit is admissible", admissible),
            ("located", "", "whether the event is located", located),
        ]
    )
