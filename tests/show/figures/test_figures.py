"""Figures of studies, from synthetic datasets: legible, exact, and reproducible."""

import functools

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.image import imread
from PIL import Image
from slow_cases import slow_but
from synthetic import BETA, couette, mixed, reduced, viscoelastic
from tests.show.figures.legibility import faults
from tests.study_modules import ROOT, module_of_study

from roughgas.base import InputError
from roughgas.show import style
from roughgas.show.catalogue import figures_of
from roughgas.show.gallery import draw
from roughgas.theory import cooling_ratio, sonine_state
from roughgas.theory.prediction import predicted_ratio

STUDIES, PAPER = ROOT / "studies", ROOT / "studies" / "paper"
paper = module_of_study("paper", "figure")


def walls():
    """Return beds with R above theory; rough elastic walls feed spin, most for smooth particles."""

    def excess(r, beta):
        return 0.025 * (1 - beta**2)

    kinds = {"rough": lambda r, beta: 0.57 / (15 + 14 * beta), "particle": excess, "smooth": excess}
    sides = [
        reduced(f"vibrated_{kind}_walls", shift, r=(0.9,), beta=(-1.0, *BETA))
        for kind, shift in kinds.items()
    ]
    return reduced("vibrated", excess), *sides


def like_paper(experiment, excess=0.0):
    """Return data at all r of the paper, with excess R growing with inelasticity, and all kinds of
    symbols."""
    values = (0.6, 0.8, 0.9, 0.99)
    data = reduced(experiment, lambda r, beta: excess * (1 - r) * (1 - beta**2), r=values)
    data["contact_time_fraction"][0] = 1e-3
    data["equilibrated"][3, -1], data["equilibrated"][2, -1] = 0.0, -1.0
    return data


def sheared():
    data = like_paper("sheared", 0.1)
    return data.assign(R_unsubtracted=data.R - 0.1)


def over_third_axis(experiment, parameter, values, r=(0.9,), **options):
    beta = (-0.5, 0.0, 0.5, 1.0)
    return reduced(experiment, r=r, beta=beta, third=(parameter, values), **options)


def boundaries(experiment):
    shares = np.array([-0.02, 0.0, 0.1])[:, None, None] + np.zeros((3, 1, 4))
    values = (-1.0, 0.0, 1.0)
    spin_shares = {"input_spin_share": shares, "input_spin_share_stderr": 0.002}
    return over_third_axis(experiment, "walls.roughness", values, **spin_shares)


def mixtures(scene):
    options = {"r": (0.9,), "beta": (0.0, 1.0)}
    masses = mixed(f"{scene}_masses", ("species.second.mass", (1.0, 4.0)), **options)
    return masses, mixed(f"{scene}_sizes", ("species.second.radius", (1.0, 2.0)), **options)


def spread(scene):
    disks = [{"name": "disks", "fraction": 1}]
    disks[0]["radius"] = {"distribution": "uniform", "deviation": 0.1}
    third = "species.disks.deviation", (0.0, 0.2)
    return mixed(f"{scene}_polydisperse", third, species=disks, r=(0.9,), beta=(0.0, 1.0))


SCENES = ("cooling", "sheared", "vibrated")
VIBRATED_AND_COOLING = ("vibrated", "cooling")
WAVES = ("reversed_sawtooth", "sawtooth", "sine", "triangle")
DATA = {
    "fig1a": lambda: (like_paper("vibrated", 0.23),),
    "fig1b": walls,
    "fig2a": lambda: (sheared(),),
    "fig2b": lambda: (like_paper("cooling", -0.1),),
    "spheres": lambda: tuple(reduced(f"{scene}_spheres") for scene in SCENES),
    "friction": lambda: tuple(
        over_third_axis(name, "friction.mu", (0.0, 0.1, 1.0))
        for name in ("vibrated_friction", "cooling_friction")
    ),
    "drives": lambda: (
        over_third_axis("heated", "thermostat.spin_share", (0.0, 0.5, 1.0)),
        boundaries("floor_materials"),
        boundaries("wall_materials"),
        boundaries("shaken_walls"),
    ),
    "waves": lambda: (over_third_axis("waves", "floor.wave", WAVES, r=(0.8, 0.9)),),
    "inertia": lambda: tuple(
        over_third_axis(f"{scene}_inertia", "spin.inertia", (0.01, 1.0))
        for scene in VIBRATED_AND_COOLING
    ),
    "drives_boundaries": lambda: tuple(map(boundaries, ("floor_materials", "wall_materials"))),
    "mixtures_vibrated": lambda: mixtures("vibrated"),
    "mixtures_cooling": lambda: mixtures("cooling"),
    "viscoelastic": lambda: (viscoelastic(),),
    "couette": lambda: (couette(), sheared()),
    "mixtures_polydisperse": lambda: tuple(spread(scene) for scene in ("vibrated", "cooling")),
}


@functools.cache
def data_of(name):
    return DATA[name]()


def inputs(name, folder):
    paths = []
    for data in data_of(name):
        paths.append(folder / f"{data.attrs['experiment']}.nc")
        data.to_netcdf(paths[-1])
    return paths


def bars(axes):
    """Return the centres of error bars in an axes, an array for each series."""
    return [np.column_stack(box[0].get_xydata().T) for box in axes.containers]


def has_picture(path):
    image = imread(path)
    return image.shape[0] > 600 and image.shape[1] > 800 and image.std() > 0.05


@pytest.mark.slow
def test_a_figure_of_a_study_is_drawn_from_its_files(tmp_path):
    output, paths = tmp_path / "figures" / "friction.png", inputs("friction", tmp_path)
    experiments = [path.stem for path in paths]
    draw(STUDIES / "friction", "friction", paths, shows=experiments, output=[output])
    assert has_picture(output)


@functools.cache
def cached_figure(name):
    """Return a figure in the style of all figures, drawn once."""
    study, separator, suffix = name.partition("_")
    module = module_of_study(study, "figure") if name not in figures_of("paper") else paper
    with rc_context(style.PARAMETERS):
        return getattr(module, name if module is paper else f"draw{separator}{suffix}")(
            *data_of(name)
        )


@pytest.mark.parametrize("name", slow_but({"fig2b"}, DATA))
def test_a_figure_is_legible(name):
    assert faults(lambda: cached_figure(name)) == []


@pytest.mark.parametrize(
    "name", [name for name in DATA if not name.startswith(("mix", "visco", "couette"))]
)
def test_every_point_is_a_measured_value(name):
    measured = [data.get("input_spin_share", data.R) for data in data_of(name)]
    axes = [data[axis] for data in data_of(name) for axis in data.R.dims if axis != "wave"]
    measured_values = np.concatenate([values.values.ravel() for values in (*measured, *axes)])
    for axes in cached_figure(name).axes:
        for column in bars(axes):
            assert np.isin(column[:, 0], measured_values).all()


@pytest.mark.slow
def test_the_order_of_datasets_does_not_change_the_bytes(tmp_path):
    paths, content = inputs("fig1b", tmp_path), []
    for order in (paths, paths[::-1]):
        outputs = [tmp_path / "out" / "a.pdf", tmp_path / "out" / "a.png"]
        shows = [
            "vibrated",
            *(f"vibrated_{kind}_walls" for kind in ("rough", "particle", "smooth")),
        ]
        draw(PAPER, "fig1b", order, shows=shows, output=outputs)
        content.append([output.read_bytes() for output in outputs])
    assert content[0] == content[1]
    assert content[0][0].startswith(b"%PDF") and b"CreationDate" not in content[0][0]
    assert sorted((tmp_path / "out").iterdir()) == outputs and has_picture(outputs[1])


def test_the_order_of_outputs_does_not_change_the_picture(tmp_path):
    """The figure of the test, as a figure with a layout may, changes each time it is drawn."""

    class Changing(Figure):
        def savefig(self, *arguments, **options):
            self.text(0.5, 0.1 * (1 + len(self.texts)), "drawn")
            super().savefig(*arguments, **options)

    pictures = []
    for kinds in ((".pdf", ".png"), (".png", ".pdf", ".svg")):
        style.save(Changing(), [tmp_path / f"figure{kind}" for kind in kinds])
        pictures.append((tmp_path / "figure.png").read_bytes())
    assert pictures[0] == pictures[1]


def test_a_palette_keeps_rare_colours(tmp_path):
    """Among thousands of greys one red symbol stays red, and the background white."""
    figure = Figure(figsize=(2.0, 2.0))
    axes = figure.subplots()
    axes.imshow(np.random.default_rng(3).random((100, 100)), cmap="gray")
    axes.plot([50], [50], "o", color="#ff0000", markeredgewidth=0)
    style.save(figure, [tmp_path / "palette.png"])
    figure.savefig(tmp_path / "full.png")
    palette, full = (Image.open(tmp_path / f"{name}.png") for name in ("palette", "full"))
    assert palette.mode == "P" and palette.info["Software"] == "roughgas"
    drawn, expected = (np.asarray(image.convert("RGB"), int) for image in (palette, full))
    assert np.abs(drawn - expected).max() <= 24 and (drawn[0, 0] == 255).all()
    assert (drawn == [255, 0, 0]).all(axis=2).sum() > 20
    sizes = [(tmp_path / f"{name}.png").stat().st_size for name in ("palette", "full")]
    assert sizes[0] < 0.7 * sizes[1]


def test_points_are_the_data_and_residuals_are_data_minus_theory():
    data = reduced("vibrated", lambda r, beta: 0.03 + 0 * r * beta)
    main, residual = paper.fig1a(data).axes
    points = [column for column in bars(main) if len(column)]
    assert len(points) == 3
    np.testing.assert_allclose(points[0][:, 1], data.R.sel(r=0.99))
    beneath = [column for column in bars(residual) if len(column)]
    theory = predicted_ratio(data.attrs, 0.8, np.array(BETA))
    np.testing.assert_allclose(beneath[2][:, 1], data.R.sel(r=0.8) - theory)
    low, high = residual.get_ylim()
    assert low < 0 < 0.03 < high


def test_the_cooling_gas_is_compared_with_the_sonine_approximation():
    """There is a thin line for each r; beneath, the theory of free cooling is subtracted."""
    main, beneath = paper.fig2b(reduced("cooling", r=(0.9, 0.99))).axes
    above, below = (
        [line for line in axes.lines if line.get_linewidth() == paper.THIN["linewidth"]]
        for axes in (main, beneath)
    )
    for sonine_line, residual_line, r in zip(above[:2], below, (0.99, 0.9), strict=True):
        beta = sonine_line.get_xdata()
        assert np.array_equal(sonine_line.get_ydata(), sonine_state(r, beta).R, equal_nan=True)
        expected = sonine_line.get_ydata() - cooling_ratio(r, beta)
        assert residual_line.get_ydata()[1:] == pytest.approx(expected[1:], abs=1e-14, nan_ok=True)


def test_illegal_figures_are_refused_without_a_file(tmp_path):
    paths = inputs("fig1a", tmp_path)
    with pytest.raises(InputError, match=r"figure\.py = it: must have fig9\(\)"):
        draw(PAPER, "fig9", paths, shows=["vibrated"], output=[tmp_path / "a.pdf"])
    with pytest.raises(InputError, match=r"must end in \.pdf or \.png or \.svg"):
        draw(PAPER, "fig1a", paths, shows=["vibrated"], output=[tmp_path / "a.eps"])
    with pytest.raises(InputError, match=r"data of fig2b = vibrated: must be cooling"):
        draw(PAPER, "fig2b", paths, shows=["cooling"], output=[tmp_path / "a.pdf"])
    assert {path.name for path in tmp_path.iterdir()} == {"vibrated.nc"}
