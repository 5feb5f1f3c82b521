"""Pictures go into axes and come out of them."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import snapload
from matplotlib import pyplot
from PIL import Image

PICTURES = ["trajectory", "rotation", "velocities", "tensions"]


@pytest.fixture(scope="module")
def run():
    return snapload.cases["sliding-example"].replace(t_end=12).run(members=0)


@pytest.mark.parametrize("what", PICTURES)
def test_a_picture_is_drawn_into_the_axes_given(run, what):
    figure, (left, right) = pyplot.subplots(1, 2)
    assert run.plot(what, ax=right) is right and not left.lines and right.lines
    assert "[" in right.get_xlabel() and "[" in right.get_ylabel()
    assert run.plot(what).figure is not figure


def test_a_picture_shows_the_run(run):
    ax = run.plot("velocities")
    drawn = np.concatenate([line.get_xydata() for line in ax.lines])
    snaps = run.impacts["v_n"] > 0
    expected = np.column_stack([run.impacts["t"], run.impacts["v_n"]])[snaps]
    assert sorted(map(tuple, drawn)) == sorted(map(tuple, expected))
    path = np.concatenate([line.get_xydata() for line in run.plot().lines[:-4]])
    assert path[:, 1].max() == pytest.approx(run.norms.y_max, abs=1e-4)
    early = run.plot("tensions", color="black")
    assert {line.get_color() for line in early.lines} <= {"black", "#999999"}


@pytest.mark.parametrize("what", PICTURES)
def test_a_label_is_shown_once(run, what):
    ax = run.plot(what, label="a run")
    labels = ax.get_legend_handles_labels()[1]
    assert 0 < labels.count("a run") <= (1 if what in ("trajectory", "rotation") else 2)


def test_labels_of_start_and_end_do_not_overlap(run):
    def names(of):
        axes = of.plot("trajectory")
        return [text.get_text() for text in axes.texts if text.get_text() in ("start", "end", "start, end")]

    assert names(run) == ["start", "end"]
    assert names(snapload.Case(t_end=1e-3).run()) == ["start, end"]


@pytest.mark.parametrize("what", PICTURES)
def test_a_second_run_leaves_the_first_visible(what):
    # The first one goes on to more than twice the time of the second.
    first, second = (snapload.Case(f_o=f_o).run(members=0) for f_o in (0.3, 0.31))
    separate = [run.plot(what) for run in (first, second)]
    both = first.plot(what)
    assert second.plot(what, ax=both) is both
    for limits in ("get_xlim", "get_ylim"):
        lows, highs = zip(*(getattr(ax, limits)() for ax in separate), strict=True)
        assert getattr(both, limits)() == pytest.approx((min(lows), max(highs)), abs=1e-9)
    again = first.plot(what)
    once = again.get_ylim()
    first.plot(what, ax=again)
    assert again.get_ylim() == once
    if (legend := again.get_legend()) is not None:
        labels = [text.get_text() for text in legend.get_texts()]
        assert len(set(labels)) == len(labels)


def test_axes_that_share_their_limits_show_both_runs():
    _, (top, low) = pyplot.subplots(2, 1, sharex=True)
    first, second = (snapload.Case(f_o=f_o).run(members=0) for f_o in (0.3, 0.31))
    first.plot("rotation", ax=top)
    second.plot("rotation", ax=low)
    assert top.get_xlim() == (0, first.end.t) and first.end.t > 2 * second.end.t


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (dict(body="point", y=0, f_o=0), "the run ends at t = 0"),
        (dict(t_end=0.3), "no cable is taut"),
        (dict(), "no cable stays taut before the end:\nonly impulses"),
        (dict(f_o=0.31), "no cable stays taut:\nonly impulses"),
    ],
)
def test_the_words_in_place_of_tensions_are_true(options, words):
    run = snapload.Case(**options).run(members=0)
    assert [text.get_text() for text in run.plot("tensions").texts] == [words]
    snaps, last = (run.impacts["v_n"] > 0).any(), run.at(run.end.t)
    assert snaps == ("impulses" in words) and (max(last.T1, last.T2) > 0) == ("end" in words)


def test_an_overview_has_all_four(run):
    assert len(run.overview().axes) == 4
    with pytest.raises(ValueError, match="what = 'energy' is not allowed; allowed: 'trajectory', 'rotation'"):
        run.plot("energy")


def test_results_are_plotted():
    critical = snapload.critical_force(snapload.Case(), step=0.1, members=10)
    assert critical.plot().get_xlabel() == "$f_o$ [F]"
    proof = snapload.verify(snapload.Case(f_o=0.31))
    assert proof.plot().lines[0].get_ydata().tolist() == np.maximum(proof.differences, 1e-18).tolist()


@pytest.mark.parametrize("members", [0, 10])
def test_a_legend_hides_nothing_of_the_probability(members):
    picture = snapload.critical_force(snapload.Case(), step=0.02, members=members).plot()
    picture.figure.canvas.draw()
    assert picture.get_legend().get_window_extent().y0 >= picture.get_window_extent().y1
    assert picture.get_legend().get_window_extent().width < picture.get_window_extent().width
    wrong = snapload.verify(snapload.Case(e=0.95)).plot()
    labels = [text.get_text() for text in wrong.get_legend().get_texts()]
    assert labels == ["first wrong, predicted", "first wrong, computed"]


def test_a_notebook_gets_html5(run):
    html = run.animate(seconds=2)._repr_html_()
    assert "<canvas" in html and "requestAnimationFrame" in html and "{" + "data}" not in html


def test_animations_are_written_to_files(run, tmp_path: Path):
    moving = run.animate(stop=3.0, seconds=0.4, fps=10)
    with Image.open(moving.save(tmp_path / "run.gif")) as picture:
        assert picture.n_frames == 4
    assert "<canvas" in moving.save(tmp_path / "run.html").read_text(encoding="utf-8")
    if shutil.which("ffmpeg"):
        assert moving.save(tmp_path / "run.mp4").stat().st_size > 1000
    else:
        with pytest.raises(ValueError, match="there is no ffmpeg on this machine"):
            moving.save(tmp_path / "run.mp4")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (dict(start=5, stop=4), "0 <= start < stop"),
        (dict(fps=0), "fps = 0 is not allowed"),
        (dict(seconds=0), "seconds = 0 is not allowed"),
        (dict(seconds=1e9), "seconds = .* is not allowed"),
    ],
)
def test_mistakes_are_refused_with_a_message(run, options, message):
    with pytest.raises(ValueError, match=message):
        run.animate(**options)
    with pytest.raises(ValueError, match="ends in .gif, .mp4 or .html"):
        run.animate().save("run.avi")
