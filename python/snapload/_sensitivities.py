"""How impacts change with each key."""

from __future__ import annotations

import numpy as np

from ._ask import ask
from ._case import Case
from ._table import Table


def sensitivities(case: Case, impacts: int = 3) -> Table:
    """Derive the first impacts of a case by every key that its motion depends on.

    Parameters
    ----------
    case : Case
        The case.
    impacts : int
        How many impacts.

    Returns
    -------
    Table
        A row an impact and key: ``impact``, from 1, ``key``, the derivatives ``t``, ``v_n`` and ``impulse``, each in
        its own unit over that of the key, and ``certain``: 1 where the impact is before the horizon of the run, else
        0. Empty where the start, on the very edge of what is legal, has no neighbours.

    Raises
    ------
    ValueError
        If `impacts` is no whole number above 0.

    See Also
    --------
    snapload.Run.exponents : How fast deviations grow in the long run.

    Notes
    -----
    They are exact to rounding: the motion is run over dual numbers, once for each key. All else is held; the inertia
    follows the size of the body where it is the natural one.

    Examples
    --------
    >>> import snapload
    >>> table = snapload.sensitivities(snapload.Case(f_o=0.31), impacts=1)
    >>> row = next(row for row in table if row["key"] == "f_o")
    >>> row["impact"], round(row["t"], 3)
    (1, -0.12)
    """
    found, _ = ask("sensitivities", case, impacts=impacts)
    names = ("impact", "key", "certain", "t", "v_n", "impulse")
    numbers, keys, certain, *slopes = ([row[name] for row in found["derivatives"]] for name in names)
    derivatives = zip(names[3:], ("T", "L/T", "m L/T"), slopes, strict=True)
    return Table._of(
        [
            ("impact", "", "number of the impact", np.array(numbers, dtype=np.int64)),
            ("key", "", "key by which is derived", np.array(keys, dtype=str)),
            *(
                (name, f"{unit} over the unit of the key", f"derivative of {name}", np.array(values, dtype=np.float64))
                for name, unit, values in derivatives
            ),
            ("certain", "", "1 where the impact is before the horizon, else 0", np.array(certain, dtype=np.int64)),
        ]
    )
