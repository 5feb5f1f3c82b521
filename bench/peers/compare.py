"""Compares the impacts that a program found with the true ones."""

from dataclasses import asdict, dataclass

# An impact that is off by no more counts as right; one that is off by more may still be the same impact.
RIGHT = 1e-6
FARTHEST = 1e-3
NEAREST = 1e-5  # what doubles have lost by the horizon, where impacts are as near to each other

# Doubles end the standard case within 3e-3 of each other, by luck; what is farther off is another end.
SAME_END = 1e-2

Impact = tuple[float, int, float]  # t, cable, v_n


@dataclass
class Comparison:
    """What a program found of the true impacts before the horizon."""

    found: int
    missed: int
    invented: int
    first_wrong: int | None  # number of the first true impact that is missed, or after an invented one
    right_up_to: int  # so many impacts in a row, from the first, have the right cable and time
    end_kind_right: bool
    end_right: bool  # the kind, and the time as far as doubles can tell it
    end_time_error: float

    def row(self) -> dict[str, object]:
        return asdict(self)


def reaches(truth: list[Impact]) -> list[float]:
    """How far off each impact may be and still be told from its neighbours of the same cable."""
    out = []
    for t, cable, _ in truth:
        others = [abs(t - u) for u, other, _ in truth if other == cable and u != t]
        out.append(max(NEAREST, min(FARTHEST, min(others, default=FARTHEST) / 4.0)))
    return out


def compare(truth: list[Impact], true_end: dict, found: list[Impact], end: dict, horizon: int) -> Comparison:
    """`horizon` counts the true impacts that are compared."""
    last = truth[horizon][0] if horizon < len(truth) else float("inf")
    reach = reaches(truth)
    taken: dict[int, int] = {}
    for k, (t, cable, _) in enumerate(truth[:horizon]):
        near = [
            (abs(t - u), i)
            for i, (u, other, _) in enumerate(found)
            if other == cable and i not in taken and abs(t - u) <= reach[k]
        ]
        if near:
            taken[min(near)[1]] = k
    matched = set(taken.values())
    strays = [u for i, (u, _, _) in enumerate(found) if i not in taken and u < last]
    wrong = [k + 1 for k in range(horizon) if k not in matched]
    wrong += [sum(t < u for t, _, _ in truth) + 1 for u in strays]
    right = 0
    for (t, cable, _), (u, other, _) in zip(truth, found, strict=False):
        if cable != other or abs(t - u) > RIGHT:
            break
        right += 1
    kind_right = end["kind"] == true_end["kind"]
    end_time_error = abs(end["t"] - true_end["t"])
    return Comparison(
        found=len(matched),
        missed=horizon - len(matched),
        invented=len(strays),
        first_wrong=min(wrong, default=None),
        right_up_to=right,
        end_kind_right=kind_right,
        end_right=kind_right and end_time_error < SAME_END,
        end_time_error=end_time_error,
    )
