"""Tasks of studies, for questions that a sweep of an experiment cannot answer.

Parameters named after wildcards take their values: `task` is the name of a task, `task_folder` the
folder of a study's tasks below results/{scale}/, such as "runaway/tasks", `combined` the path below
it, without its suffix, of the dataset that combines the tasks of a study. All methods raise
InputError for unknown names and illegal settings.
"""

import functools

from roughgas.base import unknown_name_error
from roughgas.base.files import code_in
from roughgas.config import TaskSettings, study_code, study_folders
from roughgas.workflow.fingerprints import RUNNING, code_of_tasks, with_files
from roughgas.workflow.paths import TASK
from roughgas.workflow.studies import Studies, StudyProducts
from roughgas.workflow.wildcards import located


class Tasks:
    """All tasks of the studies of a configuration, for the rules that run them."""

    def __init__(self, studies: Studies) -> None:
        """Index the studies by the folders of their tasks."""
        self.studies, self.configuration = studies, studies.configuration
        self.by_task_folder = {
            folder: products
            for products in studies.named.values()
            for folder in products.task_folders
        }
        self.names = functools.cache(self._names)

    def _names(self, scale: str, task_folder: str) -> list[str]:
        """Return the names of the tasks in a folder of results, the longest runs first."""
        from roughgas.tasks.running import task_names  # loads xarray

        products = self.by_task_folder[task_folder]
        settings = self._settings(scale, task_folder)
        return task_names(products.folder, settings.study, products.task_folders[task_folder])

    def _settings(self, scale: str, task_folder: str) -> TaskSettings:
        """Return the settings at a scale of the tasks in a folder of results, checked."""
        products = self.by_task_folder[task_folder]
        module = products.task_folders[task_folder]
        return study_folders.task_settings(self.configuration, products.name, scale, module)

    def settings(self, scale: str, task_folder: str, task: str) -> str:
        """Return the settings of a task, and of the experiments that it may run, as JSON.

        `task_folder` is the folder of the task below results/{scale}/.
        """
        with located(TASK.format(scale=scale, task_folder=task_folder, task=task)):
            names = self.names(scale, task_folder)
            if task not in names:
                raise unknown_name_error("task", task, names)
            return self._settings(scale, task_folder).text

    def code(self, scale: str, task_folder: str, task: str) -> str:
        """Return the fingerprint of the code of a task, and of the files of radii that it reads.

        `task_folder` is the folder of the task below results/{scale}/.
        """
        products = self.by_task_folder[task_folder]
        code = code_of_tasks(products.folder, products.task_folders[task_folder] or "tasks")
        of_studies = [
            code
            for experiment in self._experiments(task_folder)
            for code in self.studies.sweeps.codes_of_studies(scale, experiment)
        ]
        code = with_files(code, self.settings(scale, task_folder, task))
        return " ".join([code, *dict.fromkeys(of_studies)])

    def study_options(self, task_folder: str) -> list[str]:
        """Return the options of tasks for effects and observables of studies; [] without any."""
        folders = [
            folder
            for experiment in self._experiments(task_folder)
            for folder in self.configuration.code_folders(experiment)
        ]
        return study_code.options_of(folders)

    def _experiments(self, task_folder: str) -> list[str]:
        """Return the full names of the experiments that tasks may run by a list of them."""
        tasks = self.by_task_folder[task_folder].study.tasks
        assert tasks is not None
        return [*(tasks.experiments or {}).values()]

    def priority(self, scale: str, task_folder: str, task: str) -> int:
        """Return the priority of the job of a task: the longest tasks start first.

        `task_folder` is the folder of the task below results/{scale}/.
        """
        names = self.names(scale, task_folder)
        return len(names) - names.index(task) if task in names else 0

    def folder(self, task_folder: str) -> str:
        """Return the folder, with config.yaml, of the study whose tasks are in `task_folder`."""
        return self.by_task_folder[task_folder].folder

    def module(self, task_folder: str) -> list[str]:
        """Return the option --module for the module with the tasks in `task_folder`.

        It is [] if the study has no modules.
        """
        module = self.by_task_folder[task_folder].task_folders[task_folder]
        return ["--module", module] if module else []

    # ---------------------------------------------------------------- combined

    def to_combine(self, scale: str, combined: str) -> list[str]:
        """Return the paths of all tasks that the dataset `combined` combines.

        `combined` is its path below results/{scale}/, without its suffix.
        """
        return [
            TASK.format(scale=scale, task_folder=task_folder, task=task)
            for task_folder in self._combining(combined).task_folders
            for task in self.names(scale, task_folder)
        ]

    def combined_code(self, combined: str) -> str:
        """Return the fingerprint of the code that combines tasks into the dataset `combined`.

        `combined` is its path below results/{scale}/, without its suffix.
        """
        products = self._combining(combined)
        extra_files = ["variables.yaml"] if products.has("variables.yaml") else []
        modules = [module or "results" for module in products.task_folders.values()]
        return " ".join(code_in(products.folder, name, extra_files, RUNNING) for name in modules)

    def combined_folder(self, combined: str) -> str:
        """Return the folder, with config.yaml, of the study whose tasks a dataset combines.

        `combined` is the path of the dataset below results/{scale}/, without its suffix.
        """
        return self._combining(combined).folder

    def combined_modules(self, combined: str) -> list[str]:
        """Return the option --modules for the modules whose tasks the dataset `combined` combines.

        It is [] if the study has no modules. `combined` is the path of the dataset below
        results/{scale}/, without its suffix.
        """
        modules = self._combining(combined).study.modules
        return ["--modules", *modules] if modules else []

    def _combining(self, combined: str) -> StudyProducts:
        """Return the study whose tasks the dataset `combined` combines."""
        return self.studies.by_combined[combined]

    def check(self, study: str) -> None:
        """Raise InputError if modules of tasks of a study are missing or are no Python."""
        products = self.studies.named[study]
        for task_folder, module in products.task_folders.items():
            self.names(self.configuration.scale, task_folder)
            code_in(products.folder, module or "results")
