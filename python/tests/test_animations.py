"""Animations show what the run does, for as long as they should."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
import snapload
from PIL import Image
from snapload._animate import _pictures

#: How long the mark of a snap is shown [s].
SNAP_SHOWN_S = 0.45


def scene_of(run, **options) -> dict:
    """The data that the pages and the pictures draw."""
    html = run.animate(**options)._repr_html_()
    return json.loads(re.search(r"const {scene, .*} = (.*);\n", html)[1])["scene"]


def gaps(case: snapload.Case, motion) -> np.ndarray:
    """How far the end of each cable is from where the cable is taut, along the cables and times."""
    height = np.sqrt(case.r**2 - (1 - case.a) ** 2)
    sine, cosine = np.sin(motion.theta), np.cos(motion.theta)
    return np.array(
        [
            case.r - np.hypot(motion.x + side * case.a * cosine - side, motion.y + side * case.a * sine - height)
            for side in (1, -1)
        ]
    )


@pytest.mark.parametrize("options", [dict(), dict(f_o=0.31), dict(stop_when_settled=False, t_end=30), dict(e=1.0)])
def test_a_cable_is_shown_taut_only_while_it_is(options):
    run = snapload.Case(**options).run(members=0)
    scene = scene_of(run, seconds=8)
    taut, slack = np.array(scene["taut"], dtype=bool), gaps(run.case, run.at(np.linspace(0, run.end.t, 200))) > 1e-9
    assert not (taut & slack).any()
    # Some cables are taut when the body settles, and while it rests after that.
    assert taut.any() == (run.end.reason == "settled" or "stop_when_settled" in options)


def test_the_mark_of_a_snap_fades_within_half_a_second_of_playing():
    run = snapload.Case(f_o=0.31).run(members=0)
    seconds, fps = 60, 20
    scene = scene_of(run, seconds=seconds, fps=fps)
    for cable, bright in enumerate(np.array(scene["snaps"]), 1):
        impacts = run.impacts
        snaps = impacts["t"][impacts["cable"] == cable] / run.end.t * (seconds * fps - 1) / fps
        for picture, now in enumerate(np.arange(seconds * fps) / fps):
            ages = [now - snap for snap in snaps if snap <= now + 1e-9]
            expected = max(0, 1 - min(ages, default=1) / SNAP_SHOWN_S)
            assert bright[picture] == pytest.approx(expected, abs=1e-3)
    # With one picture a second every snap is still in a picture.
    slow = np.array(scene_of(run, seconds=8, fps=1)["snaps"])
    assert (slow.max(axis=1) > 0.4).all()


@pytest.mark.parametrize("fps", [20, 30, 24, 7, 50])
def test_a_gif_lasts_as_long_as_its_animation(fps, tmp_path):
    moving = snapload.Case(f_o=0.31).run(members=0).animate(seconds=1, fps=fps)
    with Image.open(moving.save(tmp_path / "run.gif")) as picture:
        durations_ms = []
        for frame in range(picture.n_frames):
            picture.seek(frame)
            durations_ms.append(picture.info["duration"])
    assert sum(durations_ms) == 1000
    assert {round(duration * fps / 1000) for duration in durations_ms} == {1}


def test_a_picture_of_a_gif_is_as_if_all_of_it_were_drawn():
    moving = snapload.Case(f_o=0.31).run(members=0).animate(seconds=1, fps=10)
    pictures = list(_pictures(*moving._drawing(), 10, lambda: None))
    canvas, _, move = moving._drawing()
    for k, picture in enumerate(pictures):
        move(k)
        canvas.draw()
        assert (np.asarray(picture) == np.asarray(canvas.buffer_rgba())[..., :3]).all()
    assert len({picture.tobytes() for picture in pictures}) == 10


def test_a_gif_with_more_pictures_than_browsers_show_is_refused(tmp_path):
    moving = snapload.Case(f_o=0.31).run(members=0).animate(seconds=1, fps=51)
    with pytest.raises(ValueError, match="fps = 51 is not allowed; allowed: at most 50 in a GIF"):
        moving.save(tmp_path / "run.gif")
    assert moving.save(tmp_path / "run.html").exists() and not (tmp_path / "run.gif").exists()


def hanging(size: float) -> snapload.Run:
    """A point mass on two cables, in a unit of length that makes the distance of the anchors twice the size."""
    cables = [snapload.Cable((side * size, 1.2 * size), 1.45 * size) for side in (-1, 1)]
    forcing = snapload.Forcing((0, -size), [snapload.Sinusoid((0.5 * size, 0.2 * size), 5.0)])
    return snapload.System(snapload.Body(mass=1.0), cables, forcing, 0.5, y=0.6 * size, t_end=3).run()


@pytest.mark.parametrize("exponent", [-10, 7])
def test_an_animation_does_not_depend_on_the_unit_of_length(exponent):
    size = 2.0**exponent
    one, scaled = (scene_of(hanging(size), seconds=4) for size in (1.0, size))
    for part in ("box", "outline"):
        np.testing.assert_allclose(np.array(scaled[part]) / size, one[part], rtol=0, atol=2e-5)
    lengths, ours = np.array(scaled["frames"])[:, 1:3] / size, np.array(one["frames"])[:, 1:3]
    np.testing.assert_allclose(lengths, ours, rtol=0, atol=2e-5)
    assert np.abs(one["outline"]).max() == pytest.approx(0.008 * 1.45, abs=1e-6)


def test_the_clock_of_a_short_part_moves():
    run = snapload.Case(f_o=0.31).run(members=0)
    assert scene_of(run, seconds=2)["clockDecimals"] == 2
    scene = scene_of(run, stop=0.0085, seconds=2)
    shown = {f"{frame[0]:.{scene['clockDecimals']}f}" for frame in scene["frames"]}
    assert len(shown) == len(scene["frames"]) == 50


def test_a_run_that_ends_at_once_has_no_animation():
    run = snapload.Case(body="point", y=0.0, f_o=0.0).run(members=0)
    with pytest.raises(ValueError, match="this run ends at t = 0, where it starts"):
        run.animate()
