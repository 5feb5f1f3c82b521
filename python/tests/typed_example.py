"""A piece of a user's program, which the type checker reads."""

import numpy as np
import snapload
from numpy.typing import NDArray

case = snapload.Case(f_o=0.31, body="rigid")
run: snapload.Run = case.replace(e=0.7).run(uncertainty={"f_o": 0.01}, members=10)
ends_well: bool = not run.end.exceeds
velocities: NDArray[np.float64] = run.impacts["v_n"]
amplitude: float = snapload.cases["sliding-example"].f_o
axes = run.plot("rotation")
axes.set_title(run.end.reason)
study = snapload.sweep(case, f_o=np.linspace(0.1, 0.5, 3), omega=[0.9, 1.0], out="study.parquet", resume=True)
largest: float = float(study.rho1.max())
critical = snapload.critical_force(case, members=10).f_cr
curve = snapload.critical_force(case, over={"e": [0.5, 0.9]}).f_cr.max()
first: dict[str, object] = run.impacts[0]
copied: snapload.Case = snapload.Case(**case.keys())
if critical is not None:
    print(critical + 0.01)
print(snapload.verify(case).differences.max(), snapload.ensemble(case).ends["settled"].part)
proof: snapload.Certificate = run.certify()
confirmed: NDArray[np.float64] = proof.digits
swing = snapload.System(snapload.Body(), [snapload.Cable((0, 0), 1)], snapload.Forcing((0, -1)), 0.5, y=-1, vx=1.8)
swung: snapload.SystemRun = swing.run(uncertainty={"x": 1e-6})
speeds: NDArray[np.float64] = swung.impacts["v_n"]
snaps = swing.sweep(vx=[1.0, 1.8], restitution="0:1:3").impacts_1.sum()
scales = snapload.Scales(length=5.0, mass=800.0, force=1000.0)
metres: snapload.Table = scales.si(scales.case(r=7.5, f_o=310.0).run().impacts)
