"""Commands declared as data, and argparse built from them: errors in one line, examples as they
are written. Options that commands share, what a shell completes them to, their numbers, and where
they write: nothing is replaced but an earlier file of the same kind."""

import argparse
import re
from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from decimal import Decimal
from importlib import import_module
from pathlib import Path
from textwrap import fill
from typing import Any, NoReturn

from roughgas.base import InputError, Interval, on_one_line
from roughgas.base.files import check_place

BAD_INPUT = 2
WIDTH = 78
Option = Callable[[Any], None]
"""Adds an argument, or several, to a parser or to a group of one."""


class Command:
    """A subcommand; without `about`, its summary describes it.

    `calls` names a function of the options, "module:function" of `cli`. `writes` is the kind of its
    outputs, of BEGINNINGS; "" if their endings tell it.
    """

    def __init__(
        self,
        calls: str,
        summary: str,
        *options: Option,
        examples: tuple[str, ...],
        about: str = "",
        writes: str = "",
    ) -> None:
        self.calls, self.summary, self.options, self.examples = calls, summary, options, examples
        self.writes = writes
        self.description = about or f"{summary[0].upper()}{summary[1:]}."

    def __call__(self, options: argparse.Namespace) -> None:
        """Import and call the function."""
        module, _, name = self.calls.partition(":")
        getattr(import_module(f"roughgas.{module}"), name)(options)


def value(name: str, help: str, *, completer: Any = None, **settings: Any) -> Option:
    """Declare an option with a value, or a positional argument, as argparse's `add_argument`.

    `name` is such as "-o --output FILE"; a default is added to the help; `completer` lists what a
    shell may complete the value to.
    """
    names = name.split()
    if names[-1].isupper():
        settings["metavar"] = names.pop()
    if isinstance(settings.get("default"), str):
        help += " (default: %(default)s)"

    if names[0].startswith("-"):
        settings.setdefault("action", Given)

    def add(parser: Any) -> None:
        action = parser.add_argument(*names, help=help, **settings)
        if completer:
            action.completer = completer

    return add


class Given(argparse.Action):
    """Stores a value, which is given once; values of a list that is given in parts are joined."""

    seen = False

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        """Store what the option is given. Raises ArgumentError for a second value."""
        if self.seen and self.nargs is None:
            raise argparse.ArgumentError(self, f"given twice, the second time as {values}")
        given = [*getattr(namespace, self.dest), *values] if self.seen else values
        setattr(namespace, self.dest, given)
        self.seen = True


def flag(name: str, help: str) -> Option:
    """Declare an option without a value."""
    return value(name, help, action="store_true")


def output(help: str, metavar: str = "FILE", required: bool = True, **settings: Any) -> Option:
    """Declare -o, --output."""
    return value(f"-o --output {metavar}", help, required=required, **settings)


def one_of(*options: Option) -> Option:
    """Declare options that exclude each other."""

    def add(parser: argparse.ArgumentParser) -> None:
        group = parser.add_mutually_exclusive_group()
        for option in options:
            option(group)

    return add


class Parser(argparse.ArgumentParser):
    """A parser that reports errors in one line, and takes whatever begins like a negative number
    as a value: --beta -1:1:0.1."""

    def __init__(self, **keywords: Any) -> None:
        form = argparse.RawDescriptionHelpFormatter  # which leaves examples as they are
        super().__init__(**{"formatter_class": form, **keywords})
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        """Exit with the message."""
        said = on_one_line(f"roughgas: error: {message} (see `{self.prog} --help`)")
        self.exit(BAD_INPUT, f"{said}\n")


def add_commands(parser: Parser, commands: Mapping[str, Command]) -> None:
    """Add subcommands to a parser."""
    parsers = parser.add_subparsers(
        prog=parser.prog, metavar="COMMAND", required=True, help=argparse.SUPPRESS
    )
    for name, command in commands.items():
        title = "example:" if len(command.examples) == 1 else "examples:"
        epilog = "\n  ".join([title, *command.examples])
        about = fill(command.description, WIDTH)
        one = parsers.add_parser(name, help=command.summary, description=about, epilog=epilog)
        for option in command.options:
            option(one)
        one.set_defaults(command=command)


def overview(title: str, commands: Mapping[str, Command]) -> str:
    """Return a line for each command, below a title."""
    width = max(map(len, commands))
    lines = [f"  {name:{width}}  {command.summary}" for name, command in commands.items()]
    return "\n".join([f"{title}:", *lines])


RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MOST = 100_000  # values in a range


def _experiments(prefix: str, parsed_args: Namespace, **others: Any) -> list[str]:
    """Return the names of experiments; after a `/`, those of an experiment's variants.

    Nothing is checked, which would take longer than one waits for a completion.
    """
    from roughgas.config import in_use, load_experiment, usual_scale, variants
    from roughgas.config.study_folders import folders

    path = parsed_args.config or in_use()
    base, slash, _ = prefix.partition("/")
    if slash:
        return variants(base, load_experiment(path, base, parsed_args.scale or usual_scale(path)))
    found = _named(path, "experiments")
    for name, folder in folders(path).items():
        with suppress(Exception):  # of a broken study, which has none
            found += [f"{name}.{key}" for key in _named(folder / "config.yaml", "experiments")]
    return found


def _scales(parsed_args: Namespace, **_: Any) -> list[str]:
    """Return the names of scales."""
    from roughgas.config import in_use

    return _named(parsed_args.config or in_use(), "scales")


def _named(path: str | Path, part: str) -> list[str]:
    """Return the keys of a part of a configuration; an error makes argcomplete offer nothing."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return [*yaml.load(Path(path).read_bytes(), loader)[part]]


SCALE = value(
    "--scale", "a scale of the configuration: small, ... (default: its own)", completer=_scales
)
CONFIG = value("--config FILE", "the configuration (default: config.yaml here, or roughgas's own)")
SETTINGS = (
    SCALE,
    CONFIG,
    value("--settings JSON", "the settings, in place of --config"),
    flag("--checked", "trust --settings, which saves 0.1 s"),
)
"""Where the settings of a simulation come from."""
EXPERIMENT = value(
    "experiment EXPERIMENT",
    "its name in the configuration, or that of a variant: EXPERIMENT/VARIANT",
    completer=_experiments,
)
RESTITUTION = "normal restitution, in [0, 1]: 1 is elastic"
ROUGHNESS = "roughness, in [-1, 1]: -1 is smooth, 1 perfectly rough"
POINT = (
    EXPERIMENT,
    *SETTINGS,
    value("--r", RESTITUTION, required=True),
    value("--beta", ROUGHNESS, required=True),
)
"""What names a point, except for its seed."""
LISTED = "a list, or START:STOP:STEP"
POINTS = (
    EXPERIMENT,
    *SETTINGS,
    value("--r VALUE", f"{RESTITUTION}; {LISTED}", required=True, nargs="+"),
    value("--beta VALUE", f"{ROUGHNESS}; {LISTED}", required=True, nargs="+"),
    value(
        "--seed SEED",
        f"seeds of the random generator: 0, 1, ...; {LISTED} (default: 1)",
        nargs="+",
    ),
)
"""What names several points: each r with each beta and each seed."""
SET = value(
    "--set KEY=VALUE",
    "change settings: particles=80, schedule.measure=100, effects.friction.mu=0.3; null removes",
    nargs="+",
    default=(),
    dest="changes",
)
FROM = value("--from POINT", "continue from the last state of this dataset", dest="start_from")
RESEED = "--reseed SEED", "fresh noise for the state of --from, in place of --seed"
TAKE = (
    value("--start TIME", "time of the first frame (default: when steady)"),
    value("--length TIME", "time shown (default: by experiment)"),
    value("--frames NUMBER", "number of frames (default: 125 or 160)"),
)
"""Which part of a point is shown."""


def whole_number(key: str, text: str, low: int, high: int) -> int:
    """Return the number that the option `key` was given. Raises InputError outside [low, high]."""
    if text.isdecimal() and low <= int(text) <= high:
        return int(text)
    raise InputError(key, text, f"be a whole number in [{low}, {high}]")


def number(key: str, text: str, legal: Interval | None = None) -> float:
    """Return the number that the option `key` was given. Raises InputError if it is not legal."""
    try:
        found = float(text)
    except ValueError:
        raise InputError(key, text, "be a number") from None
    return legal.check(key, found) if legal else found


def labels(key: str, given: str | Iterable[str]) -> list[str]:
    """Return the one label, or those of a list, its ranges START:STOP:STEP written out."""
    if isinstance(given, str):
        return [given]
    return [label for text in given for label in _written_out(key, text)]


def _written_out(key: str, text: str) -> list[str]:
    """Return the labels from START to STOP, as exact as they are written; another text as it is."""
    ends = RANGE.fullmatch(text)
    if ends is None:
        return [text]
    try:
        start, stop, step = (Decimal(part) for part in ends.groups())
        count = int((stop - start) / step) + 1
    except (ArithmeticError, ValueError):
        raise InputError(key, text, "be START:STOP:STEP, such as -1:1:0.1") from None
    if not 0 < count <= MOST or stop < start:
        raise InputError(key, text, f"go up from START to STOP in at most {MOST:,} steps")
    return [str(start + k * step) for k in range(count)]


def print_completion(options: Namespace) -> None:
    """Print a shell's lines."""
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=options.shell))


INPUTS = ("inputs", "input", "files", "start_from", "config")
DATASETS = ("POINT", "REDUCED")  # as roughgas.data.netcdf has them
BEGINNINGS = {
    "a crate": rb"PK",
    ".nc": rb"\x89HDF|CDF",
    ".xyz": rb"\d+\n",
    ".gsd": rb"[\s\S]",
    ".png": rb"\x89PNG",
    ".pdf": rb"%PDF",
    ".svg": rb"<(\?xml|svg)",
    ".gif": rb"GIF8",
    ".mp4": rb"....ftyp",
}
"""How files begin, by what a command writes, or by their ending."""
LONGEST = 100  # bytes of a beginning


def check_outputs(options: Namespace, more: Iterable[str | Path] = ()) -> None:
    """Raise InputError for an output that would replace another output, an input, or a file of
    another kind, and for one in a folder that is not there; OSError where it could not be written.

    `more` are outputs that the command line does not name.
    """
    named, inputs = (
        [path for option in those for path in _paths(getattr(options, option, None))]
        for those in (("output",), INPUTS)
    )
    seen: set[Path] = set()
    for path in [*named, *map(Path, more)]:
        if path.resolve() in seen:
            raise InputError("--output", path, "be named once")
        seen.add(path.resolve())
        if any(one.exists() and path.exists() and path.samefile(one) for one in inputs):
            raise InputError("--output", path, "be another file than those that are read")
        if not path.parent.is_dir():
            raise InputError("--output", path, "lie in a folder that exists")
        check_place(path)
        _check_kind(path, options.command.writes or path.suffix)


def _paths(given: object) -> list[Path]:
    """Return the paths that an option is given; a flag is none."""
    several = given if isinstance(given, list) else [given]
    return [Path(one) for one in several if isinstance(one, str | Path)]


def _check_kind(path: Path, kind: str) -> None:
    """Raise InputError where what is at `path` is not of this kind; an empty file is of any."""
    if path.is_dir():
        raise InputError("--output", path, "be a file, and is a folder")
    if not path.is_file() or not path.stat().st_size:
        return
    if kind in DATASETS:
        from roughgas.data import netcdf

        kind = getattr(netcdf, kind)
        fits = netcdf.is_of_kind(path, kind)
    else:
        with path.open("rb") as file:
            fits = bool(re.match(BEGINNINGS.get(kind, b""), file.read(LONGEST)))
    if not fits:
        raise InputError("--output", path, f"be new, or hold {kind}: it holds something else")
