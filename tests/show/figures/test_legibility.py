"""The check of figures reports illegible elements, and nothing else."""

import pytest
from matplotlib.figure import Figure
from tests.show.figures.legibility import faults

FAULTS = {  # change of a legible figure: fault
    "texts[0].set_fontsize(6.9)": "'words' is printed at 6.9 pt",
    "figure.set_figwidth(8.0)": "'words' is printed at 6.1 pt",
    "figure.text(0.9, 0.02, 'too long for the figure')": "cut off by the edge",
    "text(0.95, 0.3, 'other words')": "'words' lies on 'other words'",
    "texts[0].set_position((0.99, 1.02))": "'words' is within 2 pt of data, at (1, 1)",
    "texts[0].set_position((0.5, 0.49))": "'words' is within 2 pt of data",
    "errorbar(0.95, 0.7, 0.39, fmt='none')": "'words' is within 2 pt of data",
    "legend(loc='lower left')": "'the legend' is within 0 pt of data",
    "set_xlim(-0.2, 0.8)": "1 points are cut off by the frame",
    "set_ylim(0, 1.2)": "1 points are cut off by the frame",
    "plot([0.5], [0.0], 'o', color='#ff0000')": "no key has the colour #ff0000",
    "plot([0.5], [0.0], 'D')": "no key has the marker 'D'",
    "plot([0.5, 0.6], [0.0, 0.0], ':')": "no key has the dashes (1.0, 1.65)",
}


def figure_with(*changes):
    figure = Figure(figsize=(4.0, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.errorbar([0, 1], [0, 1], 0.1, fmt="o-", label="points")
    axes.set(xlim=(-0.2, 1.2), ylim=(-0.2, 1.2), xticks=[0, 1], yticks=[0, 1])
    axes.set(xlabel="place", title="what is shown")
    axes.legend(loc="upper left")
    axes.text(0.9, 0.3, "words", fontsize=7)
    for change in changes:
        eval(f"axes.{change}", {"axes": axes})
    return figure


@pytest.mark.parametrize("change", FAULTS)
def test_each_fault_is_reported(change):
    assert any(FAULTS[change] in fault for fault in faults(lambda: figure_with(change)))


def test_paler_colours_and_lines_that_a_title_explains_have_a_key():
    """A full straight line, such as the axis at 0, needs none."""
    pale = "plot([0.5], [0.0], 'o', color='#8fbbd9')"  # half of the first colour, half white
    dashed = "plot([0.5, 0.6], [0.1, 0.1], '--', color='C0')"
    title = "get_legend().set_title('lines: theory')"
    zero = "axhline(-0.15, color='#ff0000')"
    assert faults(lambda: figure_with(pale, dashed, title, zero)) == []


def test_legible_figures_have_no_faults_nor_has_a_declared_hidden_point():
    declaration = "set_title('1 point lies outside', loc='right', fontsize=7)", "set_title('')"
    changes = "set_xlim(-0.2, 0.8)", *declaration, "texts[0].set_position((0.5, 0.1))"
    assert faults(figure_with) == faults(lambda: figure_with(*changes)) == []
