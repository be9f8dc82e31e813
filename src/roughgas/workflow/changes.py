"""Changes to a configuration from the command line, or from the host of a module."""

from collections.abc import Sequence
from pathlib import Path

from roughgas.base import NamedValues
from roughgas.config import WrittenConfiguration
from roughgas.config.forms import ConfigurationForm


def of_command_line(files: Sequence[str | Path], options: NamedValues) -> NamedValues:
    """Return the changes in `files` of --configfile; the `options` of --config take precedence.

    Files are read as `roughgas --config` reads them, since Snakemake takes 1e-4 for text. Raises
    InputError for a file that is no configuration, OSError if it cannot be read.
    """
    written = WrittenConfiguration({})
    for file in files:
        written = WrittenConfiguration.from_file(file).over(written)
    return dict(WrittenConfiguration(options).over(written).raw)


def of_host(configuration: NamedValues) -> tuple[NamedValues, list[str]]:
    """Return the changes to our configuration in the configuration of a module's host.

    The second result are the host's unrelated keys.
    """
    keys = ConfigurationForm.__struct_fields__
    changes = {key: value for key, value in configuration.items() if key in keys}
    return changes, [key for key in configuration if key not in keys]
