"""Results of a finished run: its end, its norms, and how far to trust it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._keys import LIMITS, Reason
from ._neighbours import Ensemble
from ._result import Result


@dataclass(frozen=True)
class End:
    """How a run ended.

    Attributes
    ----------
    reason : str
        The reason: ``settled``, ``rotation_limit``, ``end_time`` or another name in docs/model.md, section 7.
    t : float
        The time of the end [T].
    t_limit : float or None
        The time at which the impacts that end the run accumulate [T]; None if they do not.
    state : tuple of float
        The final x, y, theta, vx, vy, vtheta [L, rad, L/T, rad/T].

    See Also
    --------
    snapload.Run.end : The end of a run.

    Examples
    --------
    >>> import snapload
    >>> end = snapload.Case(f_o=0.31).run().end
    >>> end.reason, round(end.t, 4), round(end.state[2], 4)
    ('rotation_limit', 3.4522, 1.5708)
    """

    reason: Reason
    t: float
    t_limit: float | None
    state: tuple[float, float, float, float, float, float]

    @property
    def exceeds(self) -> bool:
        """Whether the run reached a limit of the mooring, such as the rotation limit.

        See Also
        --------
        snapload.critical_force : Finds the smallest force that exceeds a limit.

        Examples
        --------
        >>> import snapload
        >>> snapload.Case(f_o=0.31).run().end.exceeds
        True
        """
        return self.reason in LIMITS


@dataclass(frozen=True)
class Norms:
    """Norms of a run, after eqs 6.2 to 6.4 of the thesis.

    Attributes
    ----------
    rho1 : float
        Largest normal velocity of a snap [L/T].
    rho2 : float
        Sum of the normal velocities up to t = 10 [L/T].
    rho3 : float
        Sum of all normal velocities [L/T].
    y_max : float
        Highest y of the centre [L].
    theta_max : float
        Largest rotation in either direction [rad].

    See Also
    --------
    snapload.Trust : Has the errors of the norms.

    Examples
    --------
    >>> import snapload
    >>> norms = snapload.Case(f_o=0.31).run().norms
    >>> round(norms.rho1, 4), round(norms.theta_max, 4)
    (0.4921, 1.5708)
    """

    rho1: float
    rho2: float
    rho3: float
    y_max: float
    theta_max: float


@dataclass(frozen=True, repr=False, eq=False)
class Trust(Result):
    """How far a run can be trusted, and why trust ends there.

    Attributes
    ----------
    t : float or None
        The horizon, which is the time at which trust ends [T]; None if trust reaches the end of the run.
    impact : int or None
        The number of the impact at the horizon, from 1.
    because : str or None
        The reason: ``tolerance``, ``graze``, ``near_miss``, ``sticking``, ``tension``,
        ``passed_impulse``, ``simultaneous``, ``start`` or ``stop_rule``.
    tolerance : float
        Error of time or state, as two standard deviations and relative to values above 1, above which a result counts
        as not known.
    uncertainty : dict of str to float
        The assumed uncertainty in addition to rounding.
    end_error : float or None
        Error of the time of the end [T], as two standard deviations; 0 at the end time; None past the horizon.
    norm_errors : dict of str to float or None
        Errors of ``rho1``, ``rho2`` and ``rho3`` [L/T], ``y_max`` [L] and ``theta_max`` [rad]; None if the norm depends
        on the motion past the horizon.
    exponents : tuple of float or None
        Estimates of the Lyapunov exponents from this run alone, the largest first [1/T]: six, or four for a point
        mass; None where sticking removes a direction.
    grazes : tuple of dict
        Impacts that magnify a deviation by more than a hundred: ``impact``, ``v_n``, ``factor``.
    sensitivity : tuple of dict
        Derivatives of ``t``, ``v_n`` and ``impulse`` of the first impacts with respect to every key.

    See Also
    --------
    snapload.Outcome : Whether the end is certain.
    snapload.verify : Repeats the run with many digits.

    Examples
    --------
    >>> import snapload
    >>> trust = snapload.Case().run().trust
    >>> trust.impact, trust.because, round(trust.t, 3)
    (191, 'near_miss', 7.244)
    """

    t: float | None
    impact: int | None
    because: str | None
    tolerance: float
    uncertainty: dict[str, float]
    end_error: float | None
    norm_errors: dict[str, float | None]
    exponents: tuple[float | None, ...]
    grazes: tuple[dict[str, Any], ...]
    sensitivity: tuple[dict[str, Any], ...]

    _repr_fields = ("t", "impact", "because", "tolerance", "uncertainty", "end_error")


@dataclass(frozen=True)
class Outcome:
    """Whether the end of a run is certain, and how its neighbours end if it is not.

    Attributes
    ----------
    certain : bool
        Whether every neighbour within the uncertainty ends alike.
    ensemble : Ensemble or None
        How the neighbours end, as in :func:`snapload.ensemble`; None if the end is certain.

    See Also
    --------
    snapload.ensemble : Runs neighbours of a case, wherever its horizon is.

    Examples
    --------
    >>> import snapload
    >>> snapload.Case(f_o=0.31).run().outcome
    Outcome(certain=True, ensemble=None)
    """

    certain: bool
    ensemble: Ensemble | None
