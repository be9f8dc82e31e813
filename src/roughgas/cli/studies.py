"""`roughgas study` runs a task of a study."""

from argparse import Namespace

from roughgas import config, studies
from roughgas.base.errors import InputError
from roughgas.simulation.progress import Bar
from roughgas.studies.files import write_task


def study(options: Namespace) -> None:
    """Run a task."""
    module, text = studies.study(options.study), options.settings
    if text is None:
        loaded = config.load(options.config)
        text = config.as_text(config.study(loaded, options.study, options.scale))
    settings = config.study_from_text(text, options.study, "--settings")
    tasks = module.tasks(settings["study"])
    if options.task not in tasks:
        raise InputError("task", options.task, f"be one of {', '.join(tasks)}")
    with Bar(options.task, None) as bar:
        found = module.run(
            options.task,
            settings["study"],
            settings["experiments"],
            lambda done, total: bar.reach(done, total=total),
        )
    about = {"study": options.study, "task": options.task, "scale": options.scale}
    write_task(options.output, found, about | {"settings_json": text})
