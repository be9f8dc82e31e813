"""Products of studies for the rules: their paths and their inputs.

The paper is a study, whose products lie in results/{scale}/ itself. Parameters named after
wildcards take their values: `study` is the name of a study, `study_folder` the folder of its tables
below results/{scale}/, such as "friction/", or "" for the paper, `scale` the name of a scale, such
as "small". Datasets, tables and other files are given by their paths. A claim is a statement with
its judge; claims.yaml of a study has its statements. All methods raise InputError for unknown names
and illegal settings.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas.base import InputError, NamedValues, Record
from roughgas.base.reading import read_yaml
from roughgas.config import PAPER, Configuration, findings
from roughgas.config.study import LONG, Study
from roughgas.config.written_study import TASKS
from roughgas.show.catalogue import HEADINGS
from roughgas.workflow.fingerprints import code_beside
from roughgas.workflow.paths import COMBINED, documents, figure_files
from roughgas.workflow.sweeps import Sweeps


class StudyProducts:
    """Names and folders of the products of a study."""

    def __init__(self, name: str, study: Study) -> None:
        """Derive the folders of tables and tasks from the `name` of the study.

        `task_folders` maps each folder of tasks to its module, None without modules; `combined` is
        the path of the dataset of all tasks, "" without tasks.
        """
        self.name, self.study, self.folder = name, study, study.folder
        self.title, self.experiments = study.title, list(study.experiments)
        self.figures: Mapping[str, Any] = study.figures or {}
        self.table_folder = "" if name == PAPER else f"{name}/"
        self.task_folders: dict[str, str | None] = {
            f"{study.heading}/{module}": module for module in study.modules
        }
        if study.tasks is not None and not self.task_folders:
            self.task_folders = {f"{name}/{TASKS}": None}
        self.combined = ""
        if self.task_folders:
            self.combined = name if study.modules else f"{name}/data"

    @property
    def names_of_tasks(self) -> set[str]:
        """The names that stand for the dataset that combines the tasks of the study."""
        return {TASKS, *self.study.modules}

    @property
    def page(self) -> str:
        """The path of the page with its findings, in the folder of a scale."""
        return f"{self.table_folder}page.html" if self.table_folder else "report.html"

    @property
    def shown_to_claims(self) -> dict[str, list[str]]:
        """The experiments in each figure, by figure, as claims name them: tasks by the study."""
        return {
            figure: [self.name if name in self.names_of_tasks else name for name in names]
            for figure, names in self.shown.items()
        }

    def has(self, file: str) -> bool:
        """Return whether the folder of the study contains a file of this name."""
        return Path(self.folder, file).exists()

    @property
    def drawn(self) -> list[str]:
        """The names of the figures that its figure.py draws, or by default of its experiments."""
        return list(self.shown)

    @property
    def shown(self) -> Mapping[str, Sequence[str]]:
        """The experiments in each figure, by figure; a figure of an experiment shows only that."""
        return self.figures or {name: [name] for name in self.experiments}

    def tables(self, scale: str) -> dict[str, str]:
        """Return the paths of its tables, by the option of its page.

        `table` is the table of R of its experiments, `found` the table of the data of its tasks.
        """
        folder = f"results/{scale}/"
        tables = {"table": f"{folder}{self.table_folder}R.csv"} if self.experiments else {}
        return tables | ({"found": f"{folder}{self.combined}.md"} if self.combined else {})

    def claims(self, scale: str, *suffixes: str) -> list[str]:
        """Return the paths of its verdicts with each of the suffixes; none without claims.yaml."""
        path = f"results/{scale}/{self.table_folder}claims"
        return [path + suffix for suffix in suffixes] if self.has("claims.yaml") else []

    def statements(self) -> Mapping[str, Record]:
        """Return the rows of its claims.yaml, by name of the statement."""
        rows = read_yaml(Path(self.folder, "claims.yaml"))
        statements: Mapping[str, Record] = rows.get("statements", rows)
        return statements


class Studies:
    """All studies of a configuration, for the rules that make their products."""

    def __init__(self, configuration: Configuration, sweeps: Sweeps) -> None:
        """Index the studies by name, folder of tables, figure and dataset of tasks.

        Raises InputError if the study of the paper is missing or broken.
        """
        self.configuration, self.sweeps = configuration, sweeps
        self.named = {
            name: StudyProducts(name, study) for name, study in configuration.studies.items()
        }
        if PAPER not in self.named:
            reason = configuration.refused.get(PAPER, ("studies", "(nothing)", f"have {PAPER}"))
            raise InputError(*reason)
        all_products = self.named.values()
        self.by_table_folder = {products.table_folder: products for products in all_products}
        self.by_figure = {
            figure: products for products in all_products for figure in products.figures
        }
        self.by_combined = {products.combined: products for products in all_products}
        self.by_combined.pop("", None)
        self.with_movie = [
            name
            for name, products in self.named.items()
            if products.combined and products.has("movie.py")
        ]
        self.with_slides = [
            name for name, products in self.named.items() if products.has("slides.py")
        ]
        self.with_evidence = [
            name for name, products in self.named.items() if products.study.evidence
        ]

        self.long_folders = {
            products.folder: products
            for products in self.named.values()
            if products.study.long and LONG in configuration.scales
        }

    @property
    def refused(self) -> dict[str, str]:
        """The error messages of broken studies, by name."""
        refused = self.configuration.refused
        return {name: str(InputError(*reason)) for name, reason in refused.items()}

    @property
    def paper(self) -> StudyProducts:
        """The study of the paper's own figures."""
        return self.named[PAPER]

    def under_heading(self, heading: str) -> Iterator[StudyProducts]:
        """Yield the studies under a heading of the report, a key of HEADINGS."""
        return (products for products in self.named.values() if products.study.heading == heading)

    def swept(self, heading: str) -> list[str]:
        """Return the names of swept experiments of all studies under a heading of the report."""
        return [name for products in self.under_heading(heading) for name in products.experiments]

    # ---------------------------------------------------------------- products

    def products(self, study: str) -> list[str]:
        """Return the paths of all products of a study at the scale of the configuration.

        Raises InputError for a study that is broken.
        """
        if study in self.configuration.refused:
            raise InputError(*self.configuration.refused[study])
        products, scale = self.named[study], self.configuration.scale
        files = figure_files(products.drawn, scale)
        files += figure_files([study], scale, [".mp4"]) if study in self.with_movie else []
        files += figure_files([study], scale, [".html"]) if study in self.with_slides else []
        files += products.tables(scale).values()
        if not products.study.documents:
            return [*files, f"results/{scale}/{products.page}"]
        files += products.claims(scale, ".json", ".md")
        return files + documents(scale, *products.study.documents)

    def datasets(self, products: StudyProducts, names: Iterable[str], scale: str) -> list[str]:
        """Return the paths of the datasets of experiments, given by their names.

        The name TASKS, or a module's, stands for the dataset that combines the study's tasks.
        """
        of_tasks = products.names_of_tasks
        listed = list(names)
        reduced = self.sweeps.reduced(scale, [name for name in listed if name not in of_tasks])
        combined = COMBINED.format(scale=scale, combined=products.combined)
        return [*reduced, combined] if of_tasks & set(listed) else reduced

    def folder(self, study: str) -> str:
        """Return the folder of a study with its config.yaml."""
        return self.named[study].folder

    def title(self, study: str) -> str:
        """Return the title of a study, the heading of its README.md."""
        return self.named[study].title

    # ---------------------------------------------------------------- tables, verdicts, pages

    def folder_of_tables(self, study_folder: str) -> str:
        """Return the folder, with config.yaml, of the study whose tables are in `study_folder`.

        Tables lie below results/{scale}/; "" is the folder of the paper.
        """
        return self.by_table_folder[study_folder].folder

    def title_of_tables(self, study_folder: str) -> str:
        """Return the title of the study whose tables are in `study_folder`."""
        return self.by_table_folder[study_folder].title

    def heading_of_tables(self, study_folder: str) -> str:
        """Return the heading of the report that lists the tables in `study_folder`."""
        return HEADINGS[self.by_table_folder[study_folder].study.heading]

    def table_data(self, scale: str, study_folder: str) -> list[str]:
        """Return the paths of the reduced datasets of all experiments of a study.

        Its tables are in `study_folder`.
        """
        return self.sweeps.reduced(scale, self.by_table_folder[study_folder].experiments)

    def table_label(self, study_folder: str) -> dict[str, str]:
        """Return the label in Snakemake's report of the study's table of every number.

        It is {"product": title}, unique to the study whose tables are in `study_folder`.
        """
        table = "Table: every number (CSV, to download)"
        return {
            "product": f"{self.by_table_folder[study_folder].title}: {table}"
            if study_folder
            else table
        }

    def claims_data(self, scale: str, study_folder: str) -> list[str]:
        """Return the paths of the datasets that the claims of a study are judged on.

        They are all experiments, and tasks, that its statements name. Its tables are in
        `study_folder`.
        """
        products = self.by_table_folder[study_folder]
        full_names = {name.partition(".")[2]: name for name in products.experiments}
        rows = products.statements().values()
        names = [full_names.get(name, name) for row in rows for name in row["experiments"]]
        return self.datasets(products, dict.fromkeys(names), scale)

    def claims_code(self, study_folder: str) -> str:
        """Return the fingerprint of the code that judges the claims of a study.

        Its tables are in `study_folder`.
        """
        patterns = "*.py", "*.csv", "claims.yaml"
        return code_beside(self.by_table_folder[study_folder].folder, patterns, "judging", "claims")

    def claims_experiments(self, study_folder: str) -> list[str]:
        """Return the arguments ["--experiments", "STUDY.EXPERIMENT", ...] of the step `claims`.

        They name all experiments of the study whose results are in `study_folder`; [] for a study
        without experiments.
        """
        names = [name for name in self.by_table_folder[study_folder].experiments if "." in name]
        return ["--experiments", *names] if names else []

    def reservation(self, study_folder: str) -> str:
        """Return why findings and criteria do not belong to the data of a study, or "".

        Its tables are in `study_folder`.
        """
        return findings.reservation(self.configuration, self.by_table_folder[study_folder].name)

    def reservation_of_readme(self, study_folder: str) -> str:
        """Return why README.md of a study is of other data, or "".

        It is "" without findings.yaml, since README.md may then be new. The study's tables are in
        `study_folder`.
        """
        has_file = self.by_table_folder[study_folder].has(findings.FILE)
        return self.reservation(study_folder) if has_file else ""

    def evidence_data(self, scale: str, study_folder: str) -> list[str]:
        """Return the paths of the datasets that a study compares with published numbers.

        Its tables are in `study_folder`.
        """
        products = self.by_table_folder[study_folder]
        return self.datasets(products, products.study.evidence, scale)

    def evidence_shows(self, study_folder: str) -> list[str]:
        """Return the names of the experiments that a study compares with published numbers.

        Its tables are in `study_folder`.
        """
        return list(self.by_table_folder[study_folder].study.evidence)

    def evidence_code(self, study_folder: str) -> str:
        """Return the fingerprint of the code that compares a study with published numbers.

        Its tables are in `study_folder`.
        """
        folder = self.by_table_folder[study_folder].folder
        return code_beside(folder, ("*.py", "*.csv"), "judging", "claims.published")

    # ---------------------------------------------------------------- tables of long simulations

    def long_tables(self) -> list[str]:
        """Return the paths of the committed tables of simulations that take hours."""
        return [f"{folder}/long.csv" for folder in self.long_folders]

    def long_data(self, long_folder: str) -> list[str]:
        """Return the paths of the datasets of the study in `long_folder`, at the scale LONG."""
        products = self.long_folders[long_folder]
        return self.datasets(products, products.study.long, LONG)

    def long_shows(self, long_folder: str) -> list[str]:
        """Return the names of the datasets of the study in `long_folder`; `tasks` for tasks."""
        return list(self.long_folders[long_folder].study.long)

    def long_code(self, long_folder: str) -> str:
        """Return the fingerprint of the code of the study in `long_folder` that makes long.csv."""
        return code_beside(long_folder, ("*.py",), "judging", "claims.published")

    # ---------------------------------------------------------------- pages

    def page_tables(self, scale: str, study_folder: str) -> dict[str, str]:
        """Return the paths of the tables on the page of a study, by option of its page.

        Its tables are in `study_folder`.
        """
        return self.by_table_folder[study_folder].tables(scale)

    def readme(self, study_folder: str) -> list[Path]:
        """Return the path of README.md of a study, for its page; [] without one.

        Its tables are in `study_folder`.
        """
        return list(Path(self.by_table_folder[study_folder].folder).glob("README.md"))

    @staticmethod
    def page_options(inputs: NamedValues) -> list[str]:
        """Return the options --NAME=PATH of a study's page, for the inputs that are not empty.

        `inputs` are the paths of the tables and of the verdicts, by name.
        """
        options = ("table", "found", "claims")
        return [f"--{option}={inputs[option]}" for option in options if inputs.get(option)]

    def page_claims(self, scale: str, study_folder: str) -> list[str]:
        """Return the paths of the verdicts on the page of a study.

        Its tables are in `study_folder`.
        """
        return self.by_table_folder[study_folder].claims(scale, ".json")

    def page_shows(self, study_folder: str) -> str:
        """Return the experiments in each figure of a study, JSON by figure, as claims name them.

        Its tables are in `study_folder`.
        """
        return json.dumps(self.by_table_folder[study_folder].shown_to_claims)

    def page_figures(self, scale: str, study_folder: str) -> list[str]:
        """Return the paths of the pictures on the page of a study.

        Its tables are in `study_folder`.
        """
        return figure_files(self.by_table_folder[study_folder].drawn, scale, [".png"])

    def page_label(self, study_folder: str) -> dict[str, str]:
        """Return the label in Snakemake's report of a study's page, {"product": title}.

        It is unique even if titles are not. The study's tables are in `study_folder`.
        """
        products = self.by_table_folder[study_folder]
        titles = [product.title for product in self.named.values()]
        is_shared = titles.count(products.title) > 1
        return {"product": f"{products.title} ({products.name})" if is_shared else products.title}


def experiments_in_order(configuration: Configuration) -> list[str]:
    """Return the names of the experiments of the paper's figures in the order to run them in.

    Figures then appear one by one: the figure of the shortest runs first.
    """
    paper = configuration.studies.get(PAPER)
    figures = (paper and paper.figures) or {}
    shows = reversed(list(figures.values()))
    return list(dict.fromkeys(experiment for names in shows for experiment in names))
