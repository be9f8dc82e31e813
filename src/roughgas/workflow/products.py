"""Products of more than one study, and of a run as a whole: tables, pages, the article, an archive.

Parameters named after wildcards take their values: `product` is a key of PRODUCTS, `document` the
name of a document of the catalogue. All methods raise InputError for unknown names and illegal
settings. Results that are files are their paths.
"""

import json
import os
from contextlib import suppress
from pathlib import Path

from roughgas.base import InputError, files, sorted_json
from roughgas.config import PAPER
from roughgas.config.study import BEYOND, PAPERS
from roughgas.config.written_study import root_experiments
from roughgas.results.crate import project_files
from roughgas.show import catalogue
from roughgas.workflow.fingerprints import code_beside
from roughgas.workflow.paths import documents, figure_files, folder_of, with_copy
from roughgas.workflow.studies import Studies, StudyProducts
from roughgas.workflow.tasks import Tasks

ARTICLE_FIGURE = "transport_inertia"
"""Figure of a study that the article shows besides the figures of the paper."""
PRODUCTS = {
    "run_times": PAPER,
    "explore": PAPER,
    "extensions": BEYOND,
    "run_times_extensions": BEYOND,
    "explore_extensions": BEYOND,
}
"""Products on all experiments of a heading of the report, by that heading."""


class Products:
    """Products of more than one study of a configuration, for the rules that make them."""

    def __init__(self, studies: Studies, tasks: Tasks) -> None:
        """Store the studies, their tasks, and the swept experiments beyond the paper."""
        self.studies, self.tasks, self.sweeps = studies, tasks, studies.sweeps
        self.beyond = studies.swept(BEYOND)
        self.of_papers = list(studies.under_heading(PAPERS))

    def experiments(self, product: str) -> list[str]:
        """Return the names of the experiments that a product is made of."""
        return self.beyond if PRODUCTS[product] == BEYOND else self.studies.paper.experiments

    def data(self, scale: str, product: str) -> list[str]:
        """Return the paths of the reduced datasets that a product is made of."""
        return self.sweeps.reduced(scale, self.experiments(product))

    def points(self, scale: str, product: str) -> list[str]:
        """Return the paths of all points of the experiments of a product."""
        names = self.experiments(product)
        return [point for name in names for point in self.sweeps.points(scale, name)]

    def descriptions(self, scale: str, product: str) -> list[str | None]:
        """Return the descriptions of a product's experiments; None for a missing one."""
        names = self.experiments(product)
        return [self.sweeps.written(scale, name).raw.get("description") for name in names]

    def extensions(self) -> tuple[list[str], list[InputError]]:
        """Return the paths of all products of studies beyond the paper, and the studies' errors.

        Only broken studies have errors. The page of all verdicts is the last of the products.
        """
        files, refused = [], []
        for products in self.studies.under_heading(BEYOND):
            try:
                self.tasks.check(products.name)
                files += self.studies.products(products.name)
            except InputError as error:
                refused.append(error)
        scale = self.studies.configuration.scale
        return [*files, f"results/{scale}/verdicts.html"], refused

    def judged(self) -> list[StudyProducts]:
        """Return the paper, and all studies beyond it that have claims and are not broken."""
        judged = [self.studies.paper]
        for products in self.studies.under_heading(BEYOND):
            with suppress(InputError):
                self.tasks.check(products.name)
                judged.append(products)
        return [products for products in judged if products.has("claims.yaml")]

    def all_claims(self, scale: str) -> list[str]:
        """Return the paths of the verdicts on the statements of all `judged` studies."""
        return [path for products in self.judged() for path in products.claims(scale, ".json")]

    def judged_studies(self) -> str:
        """Return the title, the page and the figures of all `judged` studies, JSON by study."""
        return json.dumps(
            {
                products.name: {
                    "title": products.title,
                    "page": products.page,
                    "shows": products.shown_to_claims,
                }
                for products in self.judged()
            }
        )

    def papers(self, scale: str) -> list[str]:
        """Return the paths of all products of studies of other groups' papers, and their table.

        [] if a configuration has no such study.
        """
        if not self.of_papers:
            return []
        products = [path for study in self.of_papers for path in self.studies.products(study.name)]
        return [*products, *with_copy(scale, "papers.csv"), *documents(scale, "papers")]

    def papers_claims(self, scale: str) -> list[str]:
        """Return the paths of the verdicts on other groups' papers."""
        return [path for study in self.of_papers for path in study.claims(scale, ".json")]

    def papers_data(self, scale: str) -> list[str]:
        """Return the paths of the reduced datasets of the studies of other groups' papers."""
        return self.sweeps.reduced(scale, self.studies.swept(PAPERS))

    def papers_texts(self) -> str:
        """Return the paper and the folder of each study of another group's paper, JSON by study."""
        return sorted_json(
            {
                study.name: {"paper": study.study.paper, "folder": study.folder}
                for study in self.of_papers
            }
        )

    def papers_code(self) -> str:
        """Return the fingerprint of the code that tabulates other groups' papers."""
        hashes = [code_beside(study.folder, ["config.yaml"]) for study in self.of_papers]
        return " ".join([files.code_of("results.papers"), *hashes])

    def numbers_data(self, scale: str, source: Path) -> list[str]:
        """Return the paths of the reduced datasets that the quoted numbers are computed from.

        They are of the paper, and of the studies quoted in the page of results. Raises InputError
        if the page is not in the checkout, the `source` of the rules.
        """
        from roughgas.claims.numbers import quoted  # loads xarray

        (page,) = files_of_checkout(source, "docs", "results.md")
        named = {name.rpartition(".")[0] for name in quoted(Path(page).read_text(encoding="utf-8"))}
        names = [*self.studies.paper.experiments, *sorted(named & {*self.beyond})]
        return self.sweeps.reduced(scale, names)

    def every_reduced(self) -> list[str]:
        """Return the paths of the reduced datasets of all swept experiments."""
        configuration = self.studies.configuration
        names = [*root_experiments(configuration), *self.beyond]
        return self.sweeps.reduced(configuration.scale, names)

    def article_figures(self, scale: str) -> list[str]:
        """Return the paths of the figures of the article."""
        return figure_files([*self.studies.paper.drawn, ARTICLE_FIGURE], scale, [".pdf"])

    def article_tables(self) -> list[str]:
        """Return the paths of the tables of long simulations that the article quotes."""
        return [f"{self.studies.by_figure[ARTICLE_FIGURE].folder}/long.csv"]

    def article_code(self) -> str:
        """Return the fingerprint of the code that compiles the article, and of `article_tables`."""
        folder = self.studies.by_figure[ARTICLE_FIGURE].folder
        return code_beside(folder, ["long.csv"], "results.article")

    def paper_pictures(self, scale: str) -> list[str]:
        """Return the paths of the pictures on the report's front page."""
        return figure_files(self.studies.paper.drawn, scale, [".png"])


def document_source(scale: str, document: str) -> str:
    """Return the path of the file that a document of the report shows."""
    source = catalogue.DOCUMENTS[document].source
    return source.format(scale=scale, folder=folder_of(scale))


def document_heading(document: str) -> str:
    """Return the heading of the report under which a document stands."""
    return catalogue.DOCUMENTS[document].heading


def document_label(document: str) -> dict[str, str]:
    """Return the label of a document in Snakemake's report: {"product": title}."""
    return {"product": catalogue.DOCUMENTS[document].title}


def document_caption(document: str) -> str:
    """Return the caption of a document in the report."""
    return catalogue.DOCUMENTS[document].caption


def files_of_checkout(source: Path, folder: str, pattern: str) -> list[str]:
    """Return the paths of the files of a folder in a checkout that match a glob pattern.

    The checkout is the `source` of the rules. Raises InputError if there are none, as in an
    installed package.
    """
    files = sorted(Path(source, folder).glob(pattern))
    if not files:
        path = Path(folder, pattern if "*" not in pattern else "")
        legal = f"be a checkout of the project, whose {path} this is made of"
        raise InputError("folder of the workflow", Path(source).resolve(), legal)
    return list(map(str, files))


def files_to_pack(source: Path) -> list[str]:
    """Return the paths of the project's files that an archive packs in addition to results.

    Raises InputError if the project, the `source` of the rules, is not the present folder.
    """
    files_of_checkout(source, "", "pyproject.toml")
    if source != Path():
        raise InputError("folder", os.getcwd(), f"be {source.resolve()}, which a crate packs")
    return list(map(str, project_files()))
