"""Figures, movies and slides of studies and of experiments, and their captions in the report.

Parameters named after wildcards take their values: `figure`, `movie` and `study` are names,
`folder` is a folder of figures/, empty at the scale `paper`. All methods raise InputError for
unknown names and illegal settings.
"""

import difflib
from collections.abc import Iterable

from roughgas.base import InputError, NamedValues, all_in_rst, in_rst, short_repr
from roughgas.base.files import code_of
from roughgas.config import PAPER, WrittenExperiment, study_folders
from roughgas.config.written_study import TASKS
from roughgas.show import catalogue
from roughgas.show.pages import captions
from roughgas.workflow.fingerprints import code_beside, with_files
from roughgas.workflow.paths import COMBINED, folder_of, scale_of
from roughgas.workflow.studies import Studies
from roughgas.workflow.sweeps import URGENT

DRAWING = ("show.gallery", "plotting")
SOURCES = ("*.py", "*.csv", "claims.yaml")
MOVIES = {
    "vibrated": ("vibrated", "--r=0.9 --beta=0.5 --length=2 --frames=30"),
    "roughness": ("vibrated", "--r=0.9 --beta -1 0 1 --length=3 --frames=48"),
    "sheared": ("sheared", "--r=0.9 --beta=0.5 --frames=75"),
    "cooling": ("cooling", "--r=0.9 --beta=0.5 --length=8 --frames=80"),
    "rough_walls": ("vibrated_rough_walls", "--r=0.9 --beta=-1 --length=4 --frames=80"),
}
"""Short movies for README and docs, one for each scene: the experiment or variant, and further
options of `roughgas movie`. Movies of studies are defined in their config.yaml."""


class Figures:
    """All figures, movies and slides of a configuration, for the rules that draw them.

    `folder` is the folder, in figures/, of a scale, such as "small/", and empty at the scale
    `paper`.
    """

    def __init__(self, studies: Studies) -> None:
        """Collect the movies, MOVIES and the movies of `studies`, by name."""
        self.studies, self.sweeps = studies, studies.sweeps
        self.configuration = studies.configuration
        self.movies = dict(MOVIES)
        for products in studies.named.values():
            for movie, (experiment, *options) in (products.study.movies or {}).items():
                self.movies[movie] = experiment, " ".join(options)

    # ---------------------------------------------------------------- of studies

    def data(self, folder: str, figure: str) -> list[str]:
        """Return the paths of the datasets that a figure shows.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        products = self.studies.by_figure[figure]
        return self.studies.datasets(products, self.shows(figure), scale_of(folder))

    def shows(self, figure: str) -> list[str]:
        """Return the names of the experiments in a figure.

        TASKS, or a module, stands for the data of tasks.
        """
        return list(self.studies.by_figure[figure].figures[figure])

    def priority(self, figure: str) -> int:
        """Return the priority of the job of a figure: figures of the paper are drawn first."""
        return URGENT if self.studies.by_figure[figure].name == PAPER else 0

    def talk_data(self, scale: str, figure: str) -> list[str]:
        """Return the paths of the datasets that a figure in a talk shows."""
        return self.data(folder_of(scale), figure)

    def code(self, figure: str) -> str:
        """Return the fingerprint of the code that draws a figure, given by its name."""
        return self.drawing_code(self.studies.by_figure[figure].name)

    def study_folder(self, figure: str) -> str:
        """Return the folder, with config.yaml, of the study that a figure belongs to."""
        return self.studies.by_figure[figure].folder

    def label(self, figure: str) -> dict[str, str]:
        """Return the label of a figure in Snakemake's report: {"product": title}.

        Labels are unique, since the report merges equal ones.
        """
        if figure in catalogue.FIGURES:
            return {"product": catalogue.FIGURES[figure].title}
        return {"product": f"{self.studies.by_figure[figure].title}: {figure}"}

    def heading(self, figure: str) -> str:
        """Return the heading of the report under which a figure stands."""
        return catalogue.HEADINGS[self.studies.by_figure[figure].study.heading]

    def caption(self, figure: str) -> str:
        """Return the caption of a figure: the text after it in README.md of its study, or "".

        Of a study whose README.md is of other data it is the reason.
        """
        products = self.studies.by_figure[figure]
        if reservation := self.studies.reservation_of_readme(products.table_folder):
            return f"Not judged yet. {in_rst(reservation)}"
        return captions(products.folder, list(products.figures)).get(figure, "")

    def experiments(self, folder: str, figure: str) -> NamedValues:
        """Return the settings of the experiments in a figure by name, for its caption.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        names = [name for name in self.shows(figure) if name in self.configuration.experiments]
        scale = scale_of(folder)
        return {name: _settings_for_caption(self.sweeps.written(scale, name)) for name in names}

    def tasks(self, folder: str, figure: str) -> NamedValues:
        """Return the settings of the tasks whose data a figure shows, for its caption.

        They are by module, or by the study if it has no modules. `folder` is the folder of the
        figure's scale in figures/, "" for `paper`.
        """
        products, scale = self.studies.by_figure[figure], scale_of(folder)
        modules: dict[str, str | None] = {name: name for name in products.study.modules}
        by_name = modules or {TASKS: None}
        return {
            module or products.name: all_in_rst(
                study_folders.task_settings(self.configuration, products.name, scale, module).study
            )
            for module in (by_name[name] for name in self.shows(figure) if name in by_name)
        }

    # ---------------------------------------------------------------- of an experiment

    def plot_data(self, folder: str, plotted: str) -> list[str]:
        """Return the path of the reduced dataset of the experiment `plotted`, for its figure.

        The result is a list with a single path. `folder` is the folder of the figure's scale in
        figures/, "" for `paper`.
        """
        if plotted not in self.configuration.experiments:
            names = {*catalogue.FIGURES, *self.studies.by_figure, *self.configuration.experiments}
            raise unknown_with_suggestions("figure", plotted, "a figure or an experiment", names)
        return self.sweeps.reduced(scale_of(folder), [plotted])

    def plot_theory(self, plotted: str) -> list[str]:
        """Return the option of the command that draws the experiment `plotted`: its study's theory.

        [] for an experiment of the root, or of a study without theory.py.
        """
        study = self.studies.named.get(plotted.partition(".")[0])
        return [f"--theory={study.folder}"] if study and study.has("theory.py") else []

    def plot_code(self, plotted: str) -> str:
        """Return the fingerprint of the code that draws the experiment `plotted`."""
        modules = "show.figures.variables", "show.style"
        if not self.plot_theory(plotted):
            return code_of(*modules)
        return code_beside(self.studies.folder(plotted.partition(".")[0]), ["*.py"], *modules)

    # ---------------------------------------------------------------- in motion

    def movie_settings(self, folder: str, movie: str) -> str:
        """Return all settings that determine the points of a movie, as JSON.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        return self.sweeps.written(scale_of(folder), self._filmed(movie)).text

    def _filmed(self, movie: str) -> str:
        """Return the name of the experiment in a movie; raise InputError for an unknown movie."""
        if movie not in self.movies:
            raise InputError("movie", movie, f"be one of {', '.join(self.movies)}")
        return self.movies[movie][0]

    def movie_code(self, folder: str, movie: str) -> str:
        """Return the fingerprint of the code of a movie, and of the files of radii in it.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        code = code_of("show.movies", alone=["cli.excerpts"])
        of_studies = self.sweeps.codes_of_studies(scale_of(folder), self._filmed(movie))
        return " ".join([with_files(code, self.movie_settings(folder, movie)), *of_studies])

    def movie_options(self, movie: str) -> list[str]:
        """Return the experiment, or variant, of a movie, and the options of its command."""
        experiment, options = self.movies[movie]
        return [experiment, *options.split()]

    def movie_studies(self, folder: str, movie: str) -> list[str]:
        """Return the options of a movie for effects and observables of studies; [] without any.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        return self.sweeps.study_options(scale_of(folder), self._filmed(movie))

    def study_movie_data(self, folder: str, study: str) -> str:
        """Return the path of the dataset of tasks that the movie of a study shows.

        `folder` is the folder of its scale in figures/, "" for `paper`.
        """
        combined = self.studies.named[study].combined
        return COMBINED.format(scale=scale_of(folder), combined=combined)

    def drawing_code(self, study: str) -> str:
        """Return the fingerprint of the code that draws the figures and the movie of a study."""
        return code_beside(self.studies.folder(study), SOURCES, *DRAWING)

    def slides_data(self, folder: str, study: str) -> list[str]:
        """Return the paths of the reduced datasets that the slides of a study show.

        `folder` is the folder of their scale in figures/, "" for `paper`.
        """
        return self.sweeps.reduced(scale_of(folder), self.studies.named[study].experiments)

    def slides_code(self, study: str) -> str:
        """Return the fingerprint of the code that draws the slides of a study."""
        return code_beside(self.studies.folder(study), SOURCES, "show.slides", "plotting")


def unknown_with_suggestions(
    key: str, name: str, category: str, names: Iterable[str]
) -> InputError:
    """Return the InputError of an unknown name, with the three most similar legal `names`.

    `key` is the kind of the name, such as "figure"; `category` describes the legal names in words.
    """
    similar = difflib.get_close_matches(name, sorted(names), 3, 0.0)
    return InputError(key, short_repr(name), f"be {category}, such as {', '.join(similar)}")


def _settings_for_caption(written: WrittenExperiment) -> NamedValues:
    """Return the settings of an experiment by key, escaped for reStructuredText.

    Settings of effects and of the schedule, lists included, are written as Python's str.
    """
    settings = written.raw
    effects = {name: _values_as_text(effect or {}) for name, effect in settings["effects"].items()}
    nested = {"effects": effects, "schedule": _values_as_text(settings["schedule"])}
    return {"description": ""} | all_in_rst(settings) | nested


def _values_as_text(settings: NamedValues) -> dict[str, str]:
    """Return settings as texts escaped for reStructuredText, keys included."""
    return {in_rst(key): in_rst(str(value)) for key, value in settings.items()}
