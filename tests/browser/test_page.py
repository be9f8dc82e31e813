"""The interactive page in a real browser: menus, clicks, addresses, plots."""

import re

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.select import Select

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.theory.prediction import predicted_ratio

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POINT = re.compile(r"([\d.]+)\((\d+)\)")


@pytest.fixture
def page(finished_run, browser):
    browser.open(finished_run.folder / "results/tiny/explore.html")
    browser.wait(lambda: browser.find("#ratios canvas") and browser.find("#energies canvas"))
    yield browser
    assert browser.complaints() == []
    assert browser.requests() == []


def numbers(page):
    """Return the table of the chosen point."""
    rows = [row.text for row in page.find("#numbers th")]
    return dict(zip(rows, [cell.text for cell in page.find("#numbers td")], strict=True))


def fragment(page):
    return page.script("return decodeURIComponent(location.hash)")


def select(page, name, text):
    menu = Select(page.find(f"#{name}")[0])
    if name == "experiment":
        menu.select_by_value(text)
    else:
        menu.select_by_visible_text(text)


def agrees(shown, value, error):
    """Return whether text such as 0.357(12) agrees with a value and an error, to its last digit."""
    number, digits = POINT.search(shown.replace("−", "-")).groups()
    unit = 10.0 ** -len(number.partition(".")[2])
    return abs(float(number) - value) <= unit and abs(int(digits) * unit - error) <= unit


def check_numbers(page, finished_run, experiment, r, beta):
    """Check that the page shows the numbers of a point's datasets; return True."""
    data = read_reduced(finished_run.folder / f"results/tiny/{experiment}.nc")
    reduced_point, table = data.sel(r=float(r), beta=float(beta)), numbers(page)
    R, stderr, ci95 = (reduced_point[name].item() for name in ("R", "R_stderr", "R_ci95"))
    theory = float(predicted_ratio(data.attrs, float(r), float(beta)))
    over_time = "R over time" if "R_collisional" in data else "R"
    assert agrees(table[over_time], R, stderr)
    collisional_rows = {
        name: value for name, value in table.items() if name.startswith("R over collisions,")
    }
    assert bool(collisional_rows) == ("R_collisional" in data)
    for name, value in collisional_rows.items():
        assert ("unlike Lun's formula" in name) == (experiment == "sheared")
        R_collisional, error = (
            reduced_point[f"R_collisional{end}"].item() for end in ("", "_stderr")
        )
        assert agrees(value, R_collisional, error)
        shown = table["R over collisions − theory"].lstrip("+−")
        assert agrees(shown, abs(R_collisional - theory), error)
    low, high = map(float, table[f"95 % interval of {over_time}"].replace("−", "-").split(" to "))
    assert (low, high) == pytest.approx((R - ci95, R + ci95), abs=0.06 * ci95)
    (theory_text,) = (value for name, value in table.items() if name.startswith("theory"))
    assert float(theory_text) == pytest.approx(theory, abs=5.1e-5)
    assert agrees(table[f"{over_time} − theory"].lstrip("+−"), abs(R - theory), stderr)
    steady = "found" if reduced_point.equilibrated > 0.5 else "not found"
    if reduced_point.equilibrated < 0:
        steady = "not known: too little was measured"
    assert table["steady state"] == steady
    assert int(table["collisions"].replace(",", "")) == reduced_point.collisions
    assert float(table["CPU time"].split()[0]) == pytest.approx(
        reduced_point.kernel_seconds.item(), rel=6e-3
    )
    assert table["seeds"] == "2"
    target = f"results/tiny/{experiment}/r{r}/beta{beta}/seed1.nc"
    assert page.text("#target") == f"snakemake -j1 --force {target}"
    command = read_point(finished_run.folder / target).attrs["command"]
    assert page.text("#command") == command
    assert fragment(page) == f"#{experiment}/r{r}/beta{beta}"
    return True


def test_a_point_is_shown_at_first_and_others_when_selected(page, finished_run):
    assert check_numbers(page, finished_run, "vibrated", "0.9", "-0.5")
    select(page, "beta", "0.5")
    assert check_numbers(page, finished_run, "vibrated", "0.9", "0.5")
    select(page, "r", "0.8")
    assert check_numbers(page, finished_run, "vibrated", "0.8", "0.5")
    select(page, "experiment", "cooling")
    assert check_numbers(page, finished_run, "cooling", "0.8", "0.5")
    select(page, "experiment", "vibrated_smooth_walls")
    assert check_numbers(page, finished_run, "vibrated_smooth_walls", "0.9", "0")


def test_a_click_on_a_point_chooses_it(page, finished_run):
    page.script("location.hash = '#cooling/r0.9/beta-0.5'")
    page.wait(lambda: page.text("#title").startswith("A freely cooling gas"))
    where = """
        const row = drawnRows().find(one => one.label === "r = 0.8"), u = PLOTS.ratios;
        const box = u.over.getBoundingClientRect(), place = row.places.find(one => one.x === 0.5);
        return [box.x + u.valToPos(place.x, "x"),
          box.y + u.valToPos(place.choice.point.R, "y")].map(Math.round);"""
    actions = ActionChains(page.driver)
    actions.w3c_actions.pointer_action.move_to_location(*page.script(where))
    actions.pause(0.3).perform()
    (tip,) = [element.text for element in page.find(".tip") if element.is_displayed()]
    assert tip.startswith("r = 0.8, β = 0.5\nR = ")
    actions.click().perform()
    page.wait(lambda: fragment(page).endswith("/r0.8/beta0.5"))
    assert check_numbers(page, finished_run, "cooling", "0.8", "0.5")


def test_plots_show_the_datasets(page, finished_run):
    select(page, "experiment", "sheared")
    data = read_reduced(finished_run.folder / "results/tiny/sheared.nc").sel(r=0.8)
    drawn = page.script("""
        const { places } = drawnRows().find(one => one.label === "r = 0.8");
        const points = places.map(one => one.choice.point);
        return [places.map(one => one.x), points.map(one => one.R), points.map(one => one.stderr),
          points.map(difference), PLOTS["over-time"].data[1].length];""")
    assert drawn[:3] == [
        data.beta.values.tolist(),
        data.R.values.tolist(),
        data.R_stderr.values.tolist(),
    ]
    residual = data.R - predicted_ratio(data.attrs, 0.8, data.beta.values)
    assert drawn[3] == pytest.approx(residual.values.tolist(), abs=1e-12)
    assert 0 < drawn[4] <= 200


def test_either_average_can_be_plotted(page, finished_run):
    """Lun's formula is of averages over collisions, the paper's R of averages over time."""
    data = read_reduced(finished_run.folder / "results/tiny/vibrated.nc").sel(r=0.8)
    shown = """const { places } = drawnRows().find(one => one.label === "r = 0.8");
        return [places.map(one => shownR(one.choice.point)), at("legend").lastChild.textContent];"""
    assert page.script(shown) == [
        data.R.values.tolist(),
        "theory: Lun's formula, of averages over collisions",
    ]
    select(page, "mean", "collisions")
    assert page.script(shown) == [data.R_collisional.values.tolist(), "theory: Lun's formula"]
    assert page.text("#averaged") == "averaged over collisions, as Lun's formula"
    select(page, "experiment", "cooling")
    assert not page.find("#mean")[0].is_displayed()
    assert page.text("#averaged") == "averaged over time"


def test_energies_have_units(page):
    labels = """return [PLOTS.energies.axes[1].label,
        [...document.querySelectorAll("#energies .u-label")].map(one => one.textContent)];"""
    labels_of_series = ["time in T", "translation, E_trans", "rotation, E_rot"]
    assert page.script(labels) == ["energy / (m a²/T²)", labels_of_series]
    select(page, "experiment", "cooling")
    labels_of_series[0] = "collisions per particle"
    assert page.script(labels) == ["energy / initial E_trans", labels_of_series]


def test_a_choice_can_be_shared(finished_run, browser):
    browser.open(finished_run.folder / "results/tiny/explore.html", "#sheared/r0.8/beta0")
    assert check_numbers(browser, finished_run, "sheared", "0.8", "0")
    browser.open(finished_run.folder / "results/tiny/explore.html", "#sheared/r0.8/beta7")
    assert "no point sheared/r0.8/beta7" in browser.text("#status")
    assert check_numbers(browser, finished_run, "vibrated", "0.9", "-0.5")
    assert browser.complaints() == []
