"""The parts of a user-defined system: body, cables, forces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, SupportsFloat, TypeAlias

from ._arguments import number

#: A point or vector of the plane.
Pair: TypeAlias = tuple[float, float]

#: The largest number of a system. Far from 1 the effect of rounding would be underestimated.
LARGEST = 1e6


def within(name: str, value: SupportsFloat, low: float = -LARGEST, high: float = LARGEST, above: bool = False) -> float:
    """A number within bounds; with `above` the lower bound itself is excluded."""
    plain = number(name, value)
    if (low < plain if above else low <= plain) and plain <= high:
        return plain
    sign = "<" if above else "<="
    raise ValueError(f"{name} = {value!r} is not allowed; allowed: a number, {low:g} {sign} {name} <= {high:g}")


def pair(name: str, value: Any) -> Pair:
    """Two numbers, x and y."""
    try:
        x, y = value
    except (TypeError, ValueError):
        allowed = "its x and its y, such as (0.0, -1.0)"
        raise ValueError(f"{name} = {value!r} is not allowed; allowed: {allowed}") from None
    return within(f"{name}: x", x), within(f"{name}: y", y)


def tuple_of_parts(name: str, values: Any, kind: type, most: int | None = None) -> tuple[Any, ...]:
    """A tuple of parts of one kind."""
    one = f"snapload.{kind.__name__}"
    given = tuple(values) if isinstance(values, Iterable) else (values,)
    for place, value in enumerate(given, 1):
        if not isinstance(value, kind):
            raise TypeError(f"{name}: number {place}, {value!r}, is not allowed; allowed: a {one}")
    if most is not None and not 1 <= len(given) <= most:
        raise ValueError(f"{name}: {len(given)} of them are not allowed; allowed: 1 to {most}")
    return given


@dataclass(frozen=True)
class Body:
    """A rigid body in the plane, or a point mass.

    Parameters
    ----------
    mass : float
        The mass, including the added mass of the water. With a mass of 1, slack flight under up to eight sinusoids is
        computed in closed form, otherwise as a Taylor series. With few sinusoids the closed form is up to several
        times as fast.
    inertia : float, optional
        Moment of inertia about the centre. If left out, the body is a point mass, which does not rotate.
    radius : float, optional
        Radius of a circle about the centre.
    half_size : (float, float), optional
        Half width and half height of a rectangle about the centre, instead of the radius.

    Raises
    ------
    ValueError
        If a value is not allowed.

    See Also
    --------
    snapload.System : The system that has this body.

    Notes
    -----
    The outline is used for pictures, and its highest point for the upper bound. The motion does not depend on it.

    Examples
    --------
    >>> import snapload
    >>> snapload.Body(inertia=0.02, radius=0.2)
    Body(mass=1.0, inertia=0.02, radius=0.2, half_size=None)
    >>> snapload.Body(mass=0)
    Traceback (most recent call last):
        ...
    ValueError: mass = 0 is not allowed; allowed: a number, 0 < mass <= 1e+06
    """

    mass: float = 1.0
    inertia: float | None = None
    radius: float | None = None
    half_size: Pair | None = None

    def __post_init__(self) -> None:
        set_fields(self, mass=within("mass", self.mass, 0.0, above=True))
        if self.inertia is not None:
            set_fields(self, inertia=within("inertia", self.inertia, 0.0, above=True))
        if self.radius is not None:
            set_fields(self, radius=within("radius", self.radius, 0.0))
        if self.half_size is not None:
            half_size = pair("half_size", self.half_size)
            if min(half_size) <= 0 or self.radius is not None:
                allowed = "two numbers above 0, and no radius beside them"
                raise ValueError(f"half_size = {self.half_size!r} is not allowed; allowed: {allowed}")
            set_fields(self, half_size=half_size)
        if self.inertia is None and (self.radius or self.half_size):
            raise ValueError(
                "inertia = None is not allowed for a body with a size: None is a point mass; give its moment of inertia"
            )


@dataclass(frozen=True)
class Cable:
    """An inextensible cable from a fixed anchor to a point of the body.

    Parameters
    ----------
    anchor : (float, float)
        The position of the anchor, x and y.
    length : float
        The length of the cable.
    fairlead : (float, float)
        The point of attachment on the body: x and y from the centre, with the body upright.

    Raises
    ------
    ValueError
        If a value is not allowed.

    See Also
    --------
    snapload.System : The system that has this cable.

    Examples
    --------
    >>> import snapload
    >>> snapload.Cable(anchor=(-1, 1.2), length=1.5, fairlead=(-0.2, 0))
    Cable(anchor=(-1.0, 1.2), length=1.5, fairlead=(-0.2, 0.0))
    """

    anchor: Pair
    length: float
    fairlead: Pair = (0.0, 0.0)

    def __post_init__(self) -> None:
        length = within("length", self.length, 0.0, above=True)
        set_fields(self, anchor=pair("anchor", self.anchor), length=length, fairlead=pair("fairlead", self.fairlead))


@dataclass(frozen=True)
class Sinusoid:
    """A sinusoidal force: amplitude times cos(omega t + phase), along x and along y.

    Parameters
    ----------
    amplitude : (float, float)
        Force amplitude along x and along y.
    omega : float
        Angular frequency.
    phase : float or (float, float)
        Phase at t = 0 [rad], one for both directions or one each along x and along y.

    Raises
    ------
    ValueError
        If a value is not allowed.

    See Also
    --------
    snapload.Forcing : The forces that include this one.

    Examples
    --------
    The waves of the standard case, 0.3 cos 0.9 t along x and 0.15 sin 0.9 t along y:

    >>> import math, snapload
    >>> snapload.Sinusoid((0.3, 0.15), 0.9, phase=(0, -math.pi / 2))
    Sinusoid(amplitude=(0.3, 0.15), omega=0.9, phase=(0.0, -1.5707963267948966))
    """

    amplitude: Pair
    omega: float
    phase: Pair | float = 0.0

    def __post_init__(self) -> None:
        phase = self.phase if isinstance(self.phase, Iterable) else (self.phase, self.phase)
        set_fields(self, amplitude=pair("amplitude", self.amplitude), omega=within("omega", self.omega))
        set_fields(self, phase=pair("phase", phase))


@dataclass(frozen=True)
class Forcing:
    """The forces on the centre of the body except those of the cables: a constant force and sinusoids.

    Parameters
    ----------
    constant : (float, float)
        The constant force, x and y, including weight or buoyancy.
    sinusoids : iterable of Sinusoid
        Any number of sinusoidal forces.

    Raises
    ------
    ValueError
        If a value is not allowed.

    See Also
    --------
    snapload.System : The system that has these forces.

    Examples
    --------
    >>> import snapload
    >>> snapload.Forcing((0, -1), [snapload.Sinusoid((0.4, 0.1), 1.7)]).constant
    (0.0, -1.0)
    """

    constant: Pair
    sinusoids: tuple[Sinusoid, ...] | list[Sinusoid] = ()

    def __post_init__(self) -> None:
        set_fields(self, constant=pair("constant", self.constant))
        set_fields(self, sinusoids=tuple_of_parts("sinusoids", self.sinusoids, Sinusoid))


def set_fields(part: object, **values: object) -> None:
    """Sets checked values of a part, which can not be changed later."""
    for name, value in values.items():
        object.__setattr__(part, name, value)
