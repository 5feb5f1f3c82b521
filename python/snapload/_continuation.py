"""An orbit followed as a key changes."""

from __future__ import annotations

from collections.abc import Sequence

from . import _engine
from ._branch import Branch, options_of
from ._orbit import Orbit
from ._progress import bar


def continuation(
    orbit: Orbit,
    key: str,
    between: str | Sequence[float],
    *,
    step: float = 0.01,
    points: int = 2000,
    progress: bool = True,
) -> Branch:
    """Follow an orbit as a key changes, in both directions and round folds, as ``snapload branch`` does.

    Parameters
    ----------
    orbit : Orbit
        Where to begin.
    key : str
        The key of the case that changes.
    between : (float, float) or str
        The least and the greatest value of the key, or ``"low:high"``. The value of the orbit's case lies between.
    step : float
        Length of the first step, in the space of state, times of events, and the key.
    points : int
        Points in either direction at most.
    progress : bool
        Whether to show a bar if it takes long.

    Returns
    -------
    Branch
        Its points and events, from one end to the other.

    Raises
    ------
    ValueError
        If the key can not be followed, or an option is out of its range.

    See Also
    --------
    snapload.Case.orbit : Finds an orbit to begin with.
    Branch.switch : Goes over to another branch.

    Notes
    -----
    By pseudo-arclength, with the sequence of events held. Every point is run for one lap; a sequence that closes need
    not be a motion, and ``points.admissible`` says where it is. Python's lock is released meanwhile, and Ctrl-C ends
    it.

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
    options = options_of(key, between, step, points)
    with bar("points of the branch", 2 * options[2], progress) as tell:
        engine = _engine.continuation(orbit._engine, key, *options, tell)
    return Branch(orbit, key, options, engine)
