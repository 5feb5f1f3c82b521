"""Ensembles of neighbours of a case, and how they end."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import _engine
from ._arguments import Uncertainty, engine_case, uncertainty_for_engine, whole_number
from ._lazy_import import LazyModule
from ._progress import progress_bar

if TYPE_CHECKING:
    from . import _case
else:
    _case = LazyModule("snapload._case")


@dataclass(frozen=True)
class Share:
    """The members of an ensemble that end in the same way.

    Attributes
    ----------
    count : int
        The number of these members.
    part : float
        Their fraction of the ensemble, from 0 to 1.
    low, high : float
        The interval that contains the probability with 95 % confidence (Wilson 1927).

    See Also
    --------
    snapload.Ensemble : The whole ensemble.

    Examples
    --------
    >>> import snapload
    >>> share = snapload.ensemble(snapload.Case(f_o=0.31), 50).ends["rotation_limit"]
    >>> share.count, share.part, round(share.low, 2), share.high
    (50, 1.0, 0.93, 1.0)
    """

    count: int
    part: float
    low: float
    high: float


@dataclass(frozen=True)
class Ensemble:
    """How the neighbours of a case end.

    Attributes
    ----------
    members : int
        The number of members that were run.
    seed : int
        The seed of the members.
    ends : dict of str to Share
        The members by the reason of their end, the most frequent first.

    See Also
    --------
    snapload.ensemble : Runs the neighbours.

    Examples
    --------
    >>> import snapload
    >>> found = snapload.ensemble(snapload.Case(f_o=0.31), 50)
    >>> found.members, found.seed, list(found.ends)
    (50, 1, ['rotation_limit'])
    """

    members: int
    seed: int
    ends: dict[str, Share]

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{end.replace('_', ' ')}</td><td>{share.count}</td><td>{100 * share.part:.1f} %</td>"
            f"<td>{100 * share.low:.1f} to {100 * share.high:.1f} %</td></tr>"
            for end, share in self.ends.items()
        )
        head = "<tr><th>end</th><th>members</th><th>part</th><th>95 %</th></tr>"
        return f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>"


def ensemble(
    case: _case.Case,
    members: int = 1000,
    *,
    uncertainty: Uncertainty = None,
    seed: int = 1,
    progress: bool = True,
) -> Ensemble:
    """Run neighbours of a case, drawn uniformly from its uncertainty, and count how they end.

    Parameters
    ----------
    case : Case
        The case at the centre of the neighbours.
    members : int
        Number of neighbours.
    uncertainty : float or dict of str to float, optional
        Uncertainty of the start in either direction: one size for every start value, or a size for each key. If left
        out, only rounding is uncertain; neighbours are then drawn from 1e-12 about every start value.
    seed : int
        Seed of the neighbours; the first hundred of a thousand are the same as a hundred.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    Ensemble
        The number of neighbours for each kind of end.

    Raises
    ------
    ValueError
        If an option is out of its range, or a key can not be uncertain.

    See Also
    --------
    snapload.Case.run : Runs neighbours only if one run can not decide.
    snapload.critical_force : Runs neighbours at many force amplitudes.

    Examples
    --------
    >>> import snapload
    >>> snapload.ensemble(snapload.Case(f_o=0.31), 50).ends["rotation_limit"].count
    50
    """
    members, seed = whole_number("ensemble.members", members), whole_number("seed", seed)
    with progress_bar("neighbours", members, progress) as report_progress:
        rows = json.loads(
            _engine.ensemble(engine_case(case), uncertainty_for_engine(uncertainty), members, seed, report_progress)
        )
    ends = {row.pop("reason"): Share(**row) for row in rows}
    return Ensemble(members, seed, ends)
