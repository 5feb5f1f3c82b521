"""Pictures of basins, erosion and diagrams; Matplotlib is loaded when one is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._lazy_import import LazyModule

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray
else:
    matplotlib, xarray = LazyModule("matplotlib"), LazyModule("xarray")


def plot_basin(
    basin: xarray.Dataset | xarray.DataArray, ax: matplotlib.axes.Axes | None = None
) -> matplotlib.axes.Axes:
    """Draw a safe basin, or basins of attraction, as a map.

    Parameters
    ----------
    basin : xarray.Dataset or xarray.DataArray
        The result of :func:`snapload.safe_basin`, or the labels of :func:`snapload.basins_of_attraction`.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into; if left out, new ones of the width of a column.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, for further changes. Safe cells are light, cells that reach a limit are dark, and starts that are
        not legal are white. Undecided cells are hatched.

    Raises
    ------
    TypeError
        If the argument is something else.

    See Also
    --------
    snapload.safe_basin : Computes a safe basin.
    snapload.basins_of_attraction : Computes labels of attractors.

    Examples
    --------
    >>> import snapload
    >>> basin = snapload.safe_basin(snapload.Case(t_end=20), x="-0.2:0.2:5", y="0.05:0.4:4")
    >>> snapload.plot_basin(basin).get_xlabel()
    '$x$ [L]'
    """
    from ._basin_draw import draw_basin

    return draw_basin(basin, ax)


def plot_erosion(eroded: xarray.Dataset, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
    """Draw how a safe basin shrinks: its fraction of the window, and its integrity measures as distances.

    Parameters
    ----------
    eroded : xarray.Dataset
        The result of :func:`snapload.erosion`.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into; if left out, new ones of the width of a column.

    Returns
    -------
    matplotlib.axes.Axes
        The axes of the fraction, for further changes. The axes of the distances lie over them, with their scale on
        the right.

    Raises
    ------
    TypeError
        If the argument is something else.

    See Also
    --------
    snapload.erosion : Computes the erosion of a safe basin.

    Examples
    --------
    >>> import snapload
    >>> window = dict(x="-0.3:0.3:5", y="0.05:0.65:5")
    >>> eroded = snapload.erosion(snapload.Case(t_end=20), over={"f_o": "0:0.6:3"}, trust=False, **window)
    >>> snapload.plot_erosion(eroded).get_ylabel()
    'safe part of the starts'
    """
    from ._basin_draw import draw_erosion

    return draw_erosion(eroded, ax)


def plot_diagram(
    diagram: xarray.Dataset, y: str = "x", ax: matplotlib.axes.Axes | None = None, **style: Any
) -> matplotlib.axes.Axes:
    """Draw the section points of an attractor against the key that varies.

    Parameters
    ----------
    diagram : xarray.Dataset
        The result of :func:`snapload.orbit_diagram`.
    y : {"x", "y", "theta", "vx", "vy", "vtheta"}
        The value of the state to draw.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into; if left out, new ones of the width of a column.
    **style
        Properties of the points, such as ``color`` or ``markersize``.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, for further changes. Values at which the motion stopped at a limit are marked at the bottom.

    Raises
    ------
    TypeError
        If the argument is something else.
    ValueError
        If the quantity is unknown.

    See Also
    --------
    snapload.orbit_diagram : Computes the diagram.

    Examples
    --------
    >>> import snapload
    >>> case = snapload.Case(body="point", r=1.7, e=0.35, nu=0.8, omega=3.1)
    >>> found = snapload.orbit_diagram(case, f_o="1.4:1.5:3", periods=150, keep=40)
    >>> snapload.plot_diagram(found, "vx").get_ylabel()
    '$\\\\dot x$ [L/T]'
    """
    from ._basin_draw import draw_diagram

    return draw_diagram(diagram, y, ax, style)
