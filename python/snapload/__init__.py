"""Dynamics of bodies on cables that go slack and snap taut.

A floating breakwater moored by two cables moves in waves. The cables go slack and snap taut, and each snap is an
impact. The package has the engine of the command ``snapload`` and gives the same results to the last bit.

>>> import snapload
>>> run = snapload.Case(f_o=0.31).run()
>>> run.end.reason, len(run.impacts)
('rotation_limit', 12)

All quantities are nondimensional. Lengths are in L, half the distance between the anchors; masses in m, the mass of
the body; forces in F, its net buoyancy; times in T = sqrt(m L / F).
"""

from __future__ import annotations

from typing import get_type_hints

from ._axes import evenly
from ._basin import basins_of_attraction, erosion, safe_basin
from ._basin_plot import plot_basin, plot_diagram, plot_erosion
from ._branch import Branch
from ._case import Case, cases
from ._certify import Certificate
from ._continuation import continuation
from ._critical import CriticalForce, critical_force
from ._engine import __version__
from ._hydro import Hydro
from ._long_run import LyapunovSpectrum, lyapunov_spectrum, orbit_diagram, section
from ._neighbours import Ensemble, Share, ensemble
from ._orbit import Orbit, SystemOrbit, find_orbits
from ._orbit_base import Admissible, NoOrbitError
from ._reproduce import reproduce
from ._run import Run
from ._run_results import End, Norms, Outcome, Trust
from ._scales import Scales
from ._sensitivities import sensitivities
from ._structure import Structure
from ._structure_results import Assessment, Elastic, Seas
from ._sweep import merge, open_study, sweep
from ._system import System, SystemRun
from ._system_parts import Body, Cable, Forcing, Sinusoid
from ._table import Table
from ._verify import Verification, verify

__all__ = [
    "Admissible",
    "Assessment",
    "Body",
    "Branch",
    "Cable",
    "Case",
    "Certificate",
    "CriticalForce",
    "Elastic",
    "End",
    "Ensemble",
    "Forcing",
    "Hydro",
    "LyapunovSpectrum",
    "NoOrbitError",
    "Norms",
    "Orbit",
    "Outcome",
    "Run",
    "Scales",
    "Seas",
    "Share",
    "Sinusoid",
    "Structure",
    "System",
    "SystemOrbit",
    "SystemRun",
    "Table",
    "Trust",
    "Verification",
    "__version__",
    "basins_of_attraction",
    "cases",
    "continuation",
    "critical_force",
    "ensemble",
    "erosion",
    "evenly",
    "find_orbits",
    "lyapunov_spectrum",
    "merge",
    "open_study",
    "orbit_diagram",
    "plot_basin",
    "plot_diagram",
    "plot_erosion",
    "reproduce",
    "safe_basin",
    "section",
    "sensitivities",
    "sweep",
    "verify",
]

# Public classes report the module from which they are imported; their annotations are resolved where they were written.
for _name in __all__:
    if isinstance(_item := globals()[_name], type):
        _item.__annotations__ = get_type_hints(_item)
        _item.__module__ = __name__
del _name, _item
