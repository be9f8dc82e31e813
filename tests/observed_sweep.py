"""A reduced dataset with results of observables that are known beforehand."""

import numpy as np
import xarray as xr
from synthetic import reduced

ATTRIBUTES = {
    "fast": {"long_name": "share of fast particles", "units": "1"},
    "squares": {"long_name": "mean squares", "units": "a^2 T^-2"},
    "profile": {"long_name": "speed in a layer", "units": "a/T"},
}


def observed_sweep(third=None, trusted=1.0):
    """R of theory, `fast` = (1 + beta)/10, `squares` of two sides, and a `profile` over heights.

    All have the standard error 0.01; `trusted` is the flag of the last two values of `fast`.
    """
    data = reduced("own.gas", r=(0.8, 0.9), beta=(-0.5, 0.0, 0.5), third=third)
    data = data.assign_coords(side=["x", "y"], height=("height", np.arange(4.0), {"units": "a"}))
    fast = 0.1 * (1.0 + data.beta) + 0.0 * data.R
    squares = fast * xr.DataArray([1.0, 2.0], dims="side")
    profile = fast * xr.DataArray(np.arange(4.0) ** 2, dims="height")
    for name, values in {"fast": fast, "squares": squares, "profile": profile}.items():
        attributes = ATTRIBUTES[name] | {"observable": name}
        ordered = values.transpose(*data.R.dims, ...)
        flags = xr.ones_like(ordered)
        flags.values[..., -2:] = trusted if name == "fast" else 1.0
        for end, content in (("", ordered), ("_stderr", 0.01 + 0.0 * ordered), ("_trusted", flags)):
            data[f"{name}{end}"] = content.drop_vars(["side", "height"], errors="ignore")
            data[f"{name}{end}"].attrs = attributes
    return data
