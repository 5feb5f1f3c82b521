"""Keys of a case, ends of a run. Written by ``generate_keys.py`` from the engine; do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypedDict, get_args

from numpy.typing import ArrayLike

#: Why a run ends.
Reason = Literal[
    "settled",
    "rotation_limit",
    "upper_bound",
    "sliding_start",
    "end_time",
    "impact_limit",
    "standstill",
]

#: The same as names.
REASONS: tuple[Reason, ...] = get_args(Reason)

#: Those of them that are limits of the motion.
LIMITS: tuple[Reason, ...] = ("rotation_limit", "upper_bound")


@dataclass(frozen=True, kw_only=True, repr=False)
class LimitBounds:
    """The bounds of the limits of the motion; none of one that ends no run."""

    rotation_limit: float | None = None
    upper_bound: float | None = None


#: The same as a section of a docstring.
LIMIT_PARAMETERS = """
    rotation_limit : float, optional
        The run ends where the rotation reaches this angle in either direction [rad].
    upper_bound : float, optional
        The run ends where the highest point of the body reaches this height.
"""

#: Keys that None takes back to what holds without them.
OPTIONAL = ("inertia",)


class Keys(TypedDict, total=False):
    """The keys that a case takes."""

    r: float
    e: float
    a: float
    b: float
    inertia: float | None
    f_o: float
    nu: float
    omega: float
    x: float
    y: float
    theta: float
    vx: float
    vy: float
    vtheta: float
    t_end: float
    v_stick: float
    stop_when_settled: bool
    stop_when_sliding: bool
    max_impacts: int
    body: Literal["rigid", "point"]


class Axes(TypedDict, total=False):
    """The keys that a study varies."""

    r: ArrayLike
    e: ArrayLike
    a: ArrayLike
    b: ArrayLike
    inertia: ArrayLike
    f_o: ArrayLike
    nu: ArrayLike
    omega: ArrayLike
    x: ArrayLike
    y: ArrayLike
    theta: ArrayLike
    vx: ArrayLike
    vy: ArrayLike
    vtheta: ArrayLike
    t_end: ArrayLike
    v_stick: ArrayLike
    stop_when_settled: ArrayLike
    stop_when_sliding: ArrayLike
    max_impacts: ArrayLike
    body: ArrayLike


class KeyValues:
    """The keys of a case as properties."""

    def keys(self) -> dict[str, Any]:
        """Every key in effect with its value."""
        raise NotImplementedError

    @property
    def r(self) -> float:
        """Length of the cables [L]."""
        value: float = self.keys()["r"]
        return value

    @property
    def e(self) -> float:
        """Coefficient of restitution of a snap: v_n after = -e v_n before."""
        value: float = self.keys()["e"]
        return value

    @property
    def a(self) -> float:
        """Half-width of the body [L]."""
        value: float = self.keys()["a"]
        return value

    @property
    def b(self) -> float:
        """Half-height of the body; 0 is the circle [L]."""
        value: float = self.keys()["b"]
        return value

    @property
    def inertia(self) -> float | None:
        """Moment of inertia [m L^2]."""
        value: float | None = self.keys()["inertia"]
        return value

    @property
    def f_o(self) -> float:
        """Force amplitude: f_x = f_o cos(omega t) [F]."""
        value: float = self.keys()["f_o"]
        return value

    @property
    def nu(self) -> float:
        """Axis ratio of the forcing ellipse: f_y = nu f_o sin(omega t)."""
        value: float = self.keys()["nu"]
        return value

    @property
    def omega(self) -> float:
        """Frequency of the forcing [rad/T]."""
        value: float = self.keys()["omega"]
        return value

    @property
    def x(self) -> float:
        """Start: horizontal position of the centre [L]."""
        value: float = self.keys()["x"]
        return value

    @property
    def y(self) -> float:
        """Start: vertical position, towards the anchors; 0 with both cables taut [L]."""
        value: float = self.keys()["y"]
        return value

    @property
    def theta(self) -> float:
        """Start: rotation [rad]."""
        value: float = self.keys()["theta"]
        return value

    @property
    def vx(self) -> float:
        """Start: horizontal velocity [L/T]."""
        value: float = self.keys()["vx"]
        return value

    @property
    def vy(self) -> float:
        """Start: vertical velocity [L/T]."""
        value: float = self.keys()["vy"]
        return value

    @property
    def vtheta(self) -> float:
        """Start: angular velocity [rad/T]."""
        value: float = self.keys()["vtheta"]
        return value

    @property
    def t_end(self) -> float:
        """The run ends here at the latest [T]."""
        value: float = self.keys()["t_end"]
        return value

    @property
    def v_stick(self) -> float:
        """A slower snap makes the cable stay taut if its tension would be positive [L/T]."""
        value: float = self.keys()["v_stick"]
        return value

    @property
    def stop_when_settled(self) -> bool:
        """Stop where a cable sticks, or both are taut, below y = 0.05."""
        value: bool = self.keys()["stop_when_settled"]
        return value

    @property
    def stop_when_sliding(self) -> bool:
        """Stop where a cable sticks at y = 0.05 or above."""
        value: bool = self.keys()["stop_when_sliding"]
        return value

    @property
    def max_impacts(self) -> int:
        """The run ends at more impacts than this."""
        value: int = self.keys()["max_impacts"]
        return value

    @property
    def body(self) -> Literal["rigid", "point"]:
        """Kind of body: a rigid one that turns, or a point mass (a = b = 0) that does not."""
        value: Literal["rigid", "point"] = self.keys()["body"]
        return value


#: The keys as a section of a docstring.
PARAMETERS = """
    r : float, optional
        Length of the cables [L]; allowed: ``0 < r <= 1000; and r > |1 - a|``; default 1.5.
    e : float, optional
        Coefficient of restitution of a snap: v_n after = -e v_n before; allowed: ``0 <= e <= 1``; default 0.9.
    a : float, optional
        Half-width of the body [L]; allowed: ``0 <= a <= 1000``; default 0.1; 0 for a point mass.
    b : float, optional
        Half-height of the body; 0 is the circle [L]; allowed: ``0 <= b <= 1000``; default 0.
    inertia : float, optional
        Moment of inertia [m L^2]; allowed: ``1e-12 <= inertia <= 1e6; at least 1e-6 (a^2 + b^2); never given
        for a point mass``; default a^2 if b = 0 (ring), (a^2 + b^2)/3 if b > 0 (rectangle).
    f_o : float, optional
        Force amplitude: f_x = f_o cos(omega t) [F]; allowed: ``-1000 <= f_o <= 1000``; default 0.3.
    nu : float, optional
        Axis ratio of the forcing ellipse: f_y = nu f_o sin(omega t); allowed: ``-1000 <= nu <= 1000``; default
        0.5.
    omega : float, optional
        Frequency of the forcing [rad/T]; allowed: ``-1000 <= omega <= 1000``; default 0.9.
    x : float, optional
        Start: horizontal position of the centre [L]; allowed: ``-1000 <= x <= 1000``; default 0.
    y : float, optional
        Start: vertical position, towards the anchors; 0 with both cables taut [L]; allowed: ``-1000 <= y <=
        1000``; default 0.1.
    theta : float, optional
        Start: rotation [rad]; allowed: ``-1000 <= theta <= 1000; and |theta| <= pi/2; 0 for a point mass``;
        default 0.
    vx : float, optional
        Start: horizontal velocity [L/T]; allowed: ``-1000 <= vx <= 1000``; default 0.
    vy : float, optional
        Start: vertical velocity [L/T]; allowed: ``-1000 <= vy <= 1000``; default 0.
    vtheta : float, optional
        Start: angular velocity [rad/T]; allowed: ``-1000 <= vtheta <= 1000; 0 for a point mass``; default 0.
    t_end : float, optional
        The run ends here at the latest [T]; allowed: ``0 < t_end <= 1e6``; default 100.
    v_stick : float, optional
        A slower snap makes the cable stay taut if its tension would be positive [L/T]; allowed: ``1e-9 <=
        v_stick <= 0.01``; default 1e-6.
    stop_when_settled : bool, optional
        Stop where a cable sticks, or both are taut, below y = 0.05; allowed: ``True or False``; default True.
    stop_when_sliding : bool, optional
        Stop where a cable sticks at y = 0.05 or above; allowed: ``True or False``; default False.
    max_impacts : int, optional
        The run ends at more impacts than this; allowed: ``a whole number, 1 <= max_impacts <= 1e7``; default
        1000000.
    body : {"rigid", "point"}, optional
        Kind of body: a rigid one that turns, or a point mass (a = b = 0) that does not; allowed: ``"rigid" or
        "point"``; default "rigid".
"""
