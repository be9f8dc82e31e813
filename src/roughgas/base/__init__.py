"""Foundations: errors, intervals of legal numbers, optional packages, mappings and text formats."""

from roughgas.base.errors import (
    MAX_QUOTED_LENGTH,
    MIN_SIMILARITY,
    CollapseError,
    EndedEarlyError,
    InputError,
    JammedError,
    NeedsError,
    SilentError,
    as_input_errors,
    check_one_of,
    on_one_line,
    short_repr,
    unknown_name_error,
)
from roughgas.base.extras import (
    EXTRAS,
    MissingExtra,
    import_extra,
    install_advice,
)
from roughgas.base.intervals import (
    RESTITUTION,
    ROUGHNESS,
    Interval,
)
from roughgas.base.mappings import (
    Attributes,
    NamedValues,
    Record,
    merged,
    shared_entries,
)
from roughgas.base.text import (
    all_in_rst,
    as_json,
    columns,
    from_json,
    in_csv,
    in_rst,
    in_rst_with_bold,
    markdown,
    sorted_json,
    without_markup,
)

__all__ = [
    "EXTRAS",
    "MAX_QUOTED_LENGTH",
    "MIN_SIMILARITY",
    "RESTITUTION",
    "ROUGHNESS",
    "Attributes",
    "CollapseError",
    "EndedEarlyError",
    "InputError",
    "Interval",
    "JammedError",
    "MissingExtra",
    "NamedValues",
    "NeedsError",
    "Record",
    "SilentError",
    "__version__",
    "all_in_rst",
    "as_input_errors",
    "as_json",
    "check_one_of",
    "columns",
    "from_json",
    "import_extra",
    "in_csv",
    "in_rst",
    "in_rst_with_bold",
    "install_advice",
    "markdown",
    "merged",
    "on_one_line",
    "shared_entries",
    "short_repr",
    "sorted_json",
    "unknown_name_error",
    "without_markup",
]

__version__ = "0.1.0"
