"""The check of figures finds what cannot be read, and nothing in a figure that can."""

import pytest
from matplotlib.figure import Figure
from tests.show.figures.legibility import faults


def good():
    figure = Figure(figsize=(4.0, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.errorbar([0, 1], [0, 1], 0.1, fmt="o-", label="points")
    axes.set(xlim=(-0.2, 1.2), ylim=(-0.2, 1.2), xticks=[0, 1], yticks=[0, 1])
    axes.set(xlabel="place", title="what is shown")
    axes.legend(loc="upper left")
    axes.text(0.9, 0.3, "words", fontsize=7)
    return figure


def small(axes):
    axes.texts[0].set_fontsize(6.9)


def wide(axes):
    axes.figure.set_figwidth(8.0)


def off_the_figure(axes):
    axes.figure.text(0.9, 0.02, "too long for the figure")


def on_each_other(axes):
    axes.text(0.95, 0.3, "other words")


def on_a_point(axes):
    axes.texts[0].set_position((0.99, 1.02))


def on_a_line(axes):
    axes.texts[0].set_position((0.5, 0.49))


def on_an_error_bar(axes):
    axes.errorbar(0.95, 0.7, 0.39, fmt="none")


def a_legend_on_points(axes):
    axes.legend(loc="lower left")


def points_outside(axes):
    axes.set_xlim(-0.2, 0.8)


def points_on_the_frame(axes):
    axes.set_ylim(0, 1.2)


SPOILED = {
    small: "'words' is printed at 6.9 pt",
    wide: "'words' is printed at 6.1 pt",
    off_the_figure: "cut off by the edge",
    on_each_other: "'words' lies on 'other words'",
    on_a_point: "'words' is within 2 pt of data, at (1, 1)",
    on_a_line: "'words' is within 2 pt of data",
    on_an_error_bar: "'words' is within 2 pt of data",
    a_legend_on_points: "'the legend' is within 0 pt of data",
    points_outside: "1 points are cut off by the frame",
    points_on_the_frame: "1 points are cut off by the frame",
}


def test_a_figure_that_can_be_read_has_no_fault():
    assert faults(good) == []


@pytest.mark.parametrize("spoil", SPOILED)
def test_each_fault_is_found(spoil):
    def spoiled():
        figure = good()
        spoil(figure.axes[0])
        return figure

    assert any(SPOILED[spoil] in fault for fault in faults(spoiled))


def test_points_outside_are_no_fault_where_words_say_how_many():
    def spoiled():
        figure = good()
        points_outside(figure.axes[0])
        figure.axes[0].set_title("1 point lies outside", loc="right", fontsize=7)
        figure.axes[0].set_title("")
        figure.axes[0].texts[0].set_position((0.5, 0.1))
        return figure

    assert faults(spoiled) == []
