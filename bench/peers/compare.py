"""Compares the impacts that a program found with the true ones."""

from dataclasses import asdict, dataclass

# An impact that is off by no more counts as right; one that is off by more may still be the same impact.
RIGHT_TOLERANCE = 1e-6
MAX_RADIUS = 1e-3
MIN_RADIUS = 1e-5  # what doubles have lost by the horizon, where impacts are as near to each other

# Doubles end the standard case within 3e-3 of each other, by luck; what is farther off is another end.
END_TOLERANCE = 1e-2

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


def match_radii(reference: list[Impact]) -> list[float]:
    """The largest time error at which each impact is not confused with others of its cable."""
    radii = []
    for t, cable, _ in reference:
        others = [abs(t - other_t) for other_t, other, _ in reference if other == cable and other_t != t]
        radii.append(max(MIN_RADIUS, min(MAX_RADIUS, min(others, default=MAX_RADIUS) / 4.0)))
    return radii


def compare(
    reference: list[Impact], reference_end: dict, found: list[Impact], end: dict, horizon: int
) -> Comparison:
    """`horizon` counts the true impacts that are compared."""
    last = reference[horizon][0] if horizon < len(reference) else float("inf")
    radii = match_radii(reference)
    matched_to: dict[int, int] = {}
    for k, (t, cable, _) in enumerate(reference[:horizon]):
        candidates = [
            (abs(t - found_t), i)
            for i, (found_t, other, _) in enumerate(found)
            if other == cable and i not in matched_to and abs(t - found_t) <= radii[k]
        ]
        if candidates:
            matched_to[min(candidates)[1]] = k
    matched = set(matched_to.values())
    unmatched = [found_t for i, (found_t, _, _) in enumerate(found) if i not in matched_to and found_t < last]
    wrong_from = [k + 1 for k in range(horizon) if k not in matched]
    wrong_from += [sum(t < found_t for t, _, _ in reference) + 1 for found_t in unmatched]
    right_in_a_row = 0
    for (t, cable, _), (found_t, other, _) in zip(reference, found, strict=False):
        if cable != other or abs(t - found_t) > RIGHT_TOLERANCE:
            break
        right_in_a_row += 1
    kind_right = end["kind"] == reference_end["kind"]
    end_time_error = abs(end["t"] - reference_end["t"])
    return Comparison(
        found=len(matched),
        missed=horizon - len(matched),
        invented=len(unmatched),
        first_wrong=min(wrong_from, default=None),
        right_up_to=right_in_a_row,
        end_kind_right=kind_right,
        end_right=kind_right and end_time_error < END_TOLERANCE,
        end_time_error=end_time_error,
    )
