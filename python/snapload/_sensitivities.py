"""Derivatives of impacts with respect to the keys."""

from __future__ import annotations

import numpy as np

from ._case import Case
from ._question import ask
from ._table import Table


def sensitivities(case: Case, impacts: int = 3) -> Table:
    """Compute the derivatives of the first impacts of a case by every key that its motion depends on.

    Parameters
    ----------
    case : Case
        The case to run.
    impacts : int
        Number of impacts.

    Returns
    -------
    Table
        One row for each impact and key: ``impact``, from 1; ``key``; the derivatives ``t``, ``v_n`` and ``impulse``,
        each in its own unit over that of the key; and ``certain``, 1 if the impact is before the horizon of the run,
        else 0. The table is empty if the start is at the limit of what is legal and has no neighbours.

    Raises
    ------
    ValueError
        If `impacts` is not a whole number above 0.

    See Also
    --------
    snapload.Run.exponents : The growth rates of deviations in the long term.

    Notes
    -----
    The derivatives are exact to rounding, because the motion is run with dual numbers, once for each key. All other
    keys are held fixed, except that the inertia follows the size of the body where it is the natural one.

    Examples
    --------
    >>> import snapload
    >>> table = snapload.sensitivities(snapload.Case(f_o=0.31), impacts=1)
    >>> row = next(row for row in table if row["key"] == "f_o")
    >>> row["impact"], round(row["t"], 3)
    (1, -0.12)
    """
    data, _ = ask("sensitivities", case, impacts=impacts)
    names = ("impact", "key", "certain", "t", "v_n", "impulse")
    numbers, keys, certain, *columns = ([row[name] for row in data["derivatives"]] for name in names)
    derivatives = zip(names[3:], ("T", "L/T", "m L/T"), columns, strict=True)
    return Table._from_columns(
        [
            ("impact", "", "number of the impact", np.array(numbers, dtype=np.int64)),
            ("key", "", "key of the derivative", np.array(keys, dtype=str)),
            *(
                (name, f"{unit} over the unit of the key", f"derivative of {name}", np.array(values, dtype=np.float64))
                for name, unit, values in derivatives
            ),
            ("certain", "", "whether the impact is before the horizon", np.array(certain, dtype=np.bool_)),
        ]
    )
