"""Continuation of a periodic orbit in a key."""

from __future__ import annotations

from collections.abc import Sequence

from . import _engine
from ._branch import Branch, branch_options
from ._orbit import Orbit
from ._progress import progress_bar


def continuation(
    orbit: Orbit,
    key: str,
    between: str | Sequence[float],
    *,
    step: float = 0.01,
    points: int = 2000,
    progress: bool = True,
) -> Branch:
    """Follow an orbit as a key changes, in both directions and around folds, as ``snapload branch`` does.

    Parameters
    ----------
    orbit : Orbit
        The orbit from which the branch is started.
    key : str
        The key of the case to vary.
    between : (float, float) or str
        The smallest and the largest value of the key, or ``"low:high"``. The value in the orbit's case lies between.
    step : float
        Length of the first step, in the space of the state, the event times and the key.
    points : int
        Maximum number of points in each direction.
    progress : bool
        Whether to show a progress bar if the computation takes long.

    Returns
    -------
    Branch
        The branch with its points and events, from one end to the other.

    Raises
    ------
    ValueError
        If the key can not be followed, or an option is out of its range.

    See Also
    --------
    snapload.Case.orbit : Finds an orbit to start from.
    Branch.switch : Follows a branch that bifurcates from this one.

    Notes
    -----
    The method is pseudo-arclength continuation with the sequence of events held fixed. Every orbit is also simulated
    for one period, because a solution for a sequence of events need not be a possible motion;
    ``points.admissible`` says where it is one. Python's lock is released during the computation, and Ctrl-C
    interrupts it.

    Examples
    --------
    >>> import snapload
    >>> orbit = snapload.Case(body="point", r=1.7, e=0.35, f_o=1.4, nu=0.8, omega=3.1).orbit()
    >>> snapload.continuation(orbit, "f_o", "1.3:1.5").ends[-1]["because"]
    'the end of the range'
    """
    if not isinstance(orbit, Orbit):
        allowed = "an orbit of a snapload.Case, such as snapload.Case(...).orbit()"
        raise TypeError(f"orbit = {orbit!r} is not allowed; allowed: {allowed}")
    options = branch_options(key, between, step, points)
    with progress_bar("points of the branch", 2 * options[2], progress) as report_progress:
        engine = _engine.continuation(orbit._engine, key, *options, report_progress)
    return Branch(orbit, key, options, engine)
