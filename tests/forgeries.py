"""Forged files: real files with damage or edits, and files of other programs."""

import gzip
import hashlib
import io
import json
import os
import pickle
import shutil
import zipfile

import netCDF4
import numpy as np
from schedules import TINY
from tests.entry import main
from tests.files import write_all

from roughgas.base import sorted_json
from roughgas.data.netcdf import CHECKSUM_PREFIX
from roughgas.simulation.checkpoint import Checkpoint, _checksum

GAS = ["gas", "--settings", sorted_json(TINY), "--r=0.9", "--beta=0"]
NAMES = ["file.nc", "seed1.nc", "file.npz", "file.gsd", "file.json", "file"]
VALUES = [3, -1, 10**9, -0.5, 1e300, float("nan"), "x", "", "{}", "[]", "null", "\n", [1, 2], ["a"]]
NUMBERS = [0.0, -1.0, 1.5, 1e300, np.nan, np.inf, -np.inf]
TYPES = ["f4", "i1", "i8", "u2", "S1", str]


def real_files(folder, monkeypatch):
    """The path of a file of each kind that the program writes, by kind."""
    folder.mkdir(exist_ok=True)
    files = write_all(folder) | {"task": folder / "task.nc", "state": folder / "state.nc"}
    assert main(["run", *GAS, "--keep-state", "-o", str(files["state"])]) == 0
    for ending in ("nc", "xyz", "gsd"):
        files[ending] = folder / f"trajectory.{ending}"
    trajectories = [str(files[ending]) for ending in ("nc", "xyz", "gsd")]
    line = ["trajectory", *GAS, "--from", str(files["state"]), "--times", "1", "2", "-o"]
    for path in trajectories:
        assert main([*line, path]) == 0
    files["checkpoint"] = checkpoint(folder, monkeypatch)
    return files


def checkpoint(folder, monkeypatch):
    """The file that a stopped run of GAS to `out.nc` has left."""
    return stopped(folder, monkeypatch, ["run", *GAS, "-o", "out.nc"], 3)


def stopped(folder, monkeypatch, command, writing):
    """The checkpoint of `out.nc` in a folder that a command has left, stopped at a writing; the
    complete output, if there are fewer writings."""
    write_checkpoint, writings = Checkpoint.write, []

    def write(self, *arguments):
        write_checkpoint(self, *arguments)
        writings.append(self)
        if len(writings) == writing:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(Checkpoint, "write", write)
        patch.setattr(Checkpoint, "due", lambda _: True)
        patch.setattr("roughgas.simulation.gas.SHORTEST_CALL", 0.0)
        assert main(command) == 130
    return folder / "out.nc.checkpoint.npz"


def forge(rng, real, path):
    """Make a file of one kind or another at `path`; return a word on the change."""
    ways = [damage, damage, edit, edit, edit, swap, foreign, foreign]
    return ways[rng.integers(len(ways))](rng, real, path)


def pick(rng, items):
    return items[rng.integers(len(items))]


def swap(rng, real, path):
    """A real file under another name."""
    shutil.copy(pick(rng, [*real.values()]), path)
    return "swapped"


def damage(rng, real, path):
    """Flip bits of a file, cut it, put bytes in, or clear some; half of its seals are made anew."""
    kind = pick(rng, [*real])
    content = bytearray(real[kind].read_bytes())
    for _ in range(rng.integers(1, 4)):
        at, length = rng.integers(len(content)), int(rng.integers(1, 200))
        fault = pick(rng, ["flip", "flip", "cut", "insert", "clear"])
        if fault == "flip":
            content[at] ^= 1 << rng.integers(8)
        elif fault == "cut":
            del content[max(at, 1) :]
        elif fault == "insert":
            content[at:at] = rng.bytes(length)
        else:
            content[at : at + length] = bytes(len(content[at : at + length]))
    path.write_bytes(content)
    if rng.integers(2):
        seal_anew(path)
        return f"damaged and sealed: {kind}"
    return f"damaged: {kind}"


def seal_anew(path):
    """Give a file the checksum that its contents have."""
    content = path.read_bytes()
    content = content[: content.rfind(CHECKSUM_PREFIX)] if CHECKSUM_PREFIX in content else content
    path.write_bytes(content + CHECKSUM_PREFIX + hashlib.sha256(content).hexdigest().encode())


def edit(rng, real, path):
    """Take variables or attributes out of a file, or change their types, dimensions and values."""
    kind = pick(rng, [name for name in real if name not in ("xyz", "gsd")])
    if kind == "checkpoint":
        edit_arrays(rng, real[kind], path)
        return f"edited: {kind}"
    rewrite(rng, real[kind], path)
    if rng.integers(2):
        seal_anew(path)
        return f"edited and sealed: {kind}"
    return f"edited: {kind}"


def edit_arrays(rng, source, path):
    """Write a checkpoint anew, with zip's own checksums, and one to three arrays changed."""
    with np.load(source) as archive:
        content = dict(archive)
    for _ in range(rng.integers(1, 4)):
        name = pick(rng, sorted(content))
        change = pick(rng, ["remove", "type", "shape", "value", "add"])
        if change == "remove":
            del content[name]
        elif change == "type":
            content[name] = np.zeros(content[name].shape, pick(rng, ["U3", "f4", "i1", "c16"]))
        elif change == "shape":
            content[name] = np.stack([content[name]] * 2)
        elif change == "value":
            content[name] = np.zeros_like(content[name])
        else:
            content[f"{name}.more"] = content[name]
    with path.open("wb") as file:
        np.savez(file, **content)


def forge_sealed(rng, source, path):
    """Write a checkpoint anew with one to three changed arrays, and with a right checksum;
    return the changes. Each tracker has its turn."""
    with np.load(source) as archive:
        content = dict(archive)
    changes = []
    for _ in range(rng.integers(1, 4)):
        arrays = sorted({*content} - {"version", "belongs to", "sha256"})
        group = pick(rng, sorted({name.partition(".")[0] for name in arrays}))
        name = pick(rng, [array for array in arrays if array.partition(".")[0] == group])
        change = pick(rng, MEMORIES if name.endswith(".memory") else CHANGES)
        change(rng, content, name)
        changes.append(f"{change.__name__} {name}")
    content.pop("sha256")
    content["sha256"] = np.array(_checksum(content))
    with path.open("wb") as file:
        np.savez(file, **content)
    if not rng.integers(20):
        path.write_bytes(path.read_bytes().replace(b"begun.npy", b"\xff\xfe\xfd\xfc\xfb.npy"))
        changes.append("name that is no text")
    return ", ".join(changes)


def remove(rng, content, name):
    del content[name]


def retype(rng, content, name):
    content[name] = np.zeros(content[name].shape, pick(rng, ["U3", "f4", "i1", "c16", "M8[s]"]))


def reshape(rng, content, name):
    array = content[name]
    shapes = [np.stack([array] * 2), array.reshape(-1)[:-1], array[None], array.reshape(-1)[:0]]
    content[name] = pick(rng, shapes) if array.size else np.zeros(3)


def clear(rng, content, name):
    content[name] = np.zeros_like(content[name])


def spoil(rng, content, name):
    array = content[name] = content[name].copy()
    if array.size and array.dtype in (int, float) and not name.endswith(".until"):
        numbers = NUMBERS if array.dtype.kind == "f" else INTEGERS
        array.flat[rng.integers(array.size)] = pick(rng, numbers)


def rename(rng, content, name):
    endings = ["more", "", ".", "7", "\u00e9\n", "../x"]
    content[f"{name}.{pick(rng, endings)}"] = content.pop(name)


def exchange(rng, content, name):
    partner = pick(rng, sorted({*content} - {"version", "belongs to", "sha256"}))
    content[name], content[partner] = content[partner], content[name]


def misplace(rng, content, name):
    position = np.array(content.get("position", np.zeros(3, int)))
    if position.size and position.dtype == int:
        position.flat[rng.integers(position.size)] = pick(rng, INTEGERS)
    content["position"] = position


def forget(rng, content, name):
    memories = [5, [1], {}, {"looks": 1}, {1: 2}, {"a": [[]] * 1000}, eval, np.zeros(3), None]
    content[name] = np.frombuffer(pickle.dumps(pick(rng, memories)), np.uint8)


def flip(rng, content, name):
    array = content[name] = content[name].copy()
    for _ in range(rng.integers(1, 5) if array.dtype == np.uint8 and array.size else 0):
        array.flat[rng.integers(array.size)] ^= np.uint8(1 << rng.integers(8))


INTEGERS = [-1, 0, 1, 2, 5, 10**6, 10**12, 2**62, -(2**62)]
CHANGES = [remove, retype, reshape, clear, spoil, rename, exchange, misplace]
MEMORIES = [forget, forget, flip, flip, remove, reshape]


def rewrite(rng, source, path):
    """Copy a dataset, with one to three of its variables and attributes changed."""
    with netCDF4.Dataset(source) as old, netCDF4.Dataset(path, "w") as new:
        old.set_auto_maskandscale(False)
        groups = {"": old, **old.groups}
        targets = [
            (name, variable_name)
            for name, group in groups.items()
            for variable_name in group.variables
        ]
        harmed = {pick(rng, targets) for _ in range(rng.integers(0, 3))}
        for name, group in groups.items():
            copy = new.createGroup(name) if name else new
            for dim, size in group.dimensions.items():
                copy.createDimension(dim, len(size))
            spoil_attributes(rng, group, copy)
            for variable_name, variable in group.variables.items():
                how = pick(rng, ["remove", "type", "dims", "value", "attribute"])
                copy_variable(rng, copy, variable, how if (name, variable_name) in harmed else "")


def spoil_attributes(rng, old, new):
    """Copy attributes, without some or with others, in every second case."""
    attributes = {name: old.getncattr(name) for name in old.ncattrs()}
    for _ in range(rng.integers(0, 3) if attributes else 0):
        name = pick(rng, sorted(attributes))
        if rng.integers(2) and len(attributes) > 1:
            del attributes[name]
        else:
            attributes[name] = pick(rng, VALUES)
    for name, value in attributes.items():
        new.setncattr(name, value)


def copy_variable(rng, group, variable, how):
    """Create a copy of a variable with one fault."""
    if how == "remove":
        return
    dims, kind, values = variable.dimensions, variable.dtype, variable[...]
    if how == "type":
        kind = pick(rng, [dtype for dtype in TYPES if dtype != kind])
        values = np.full(variable.shape, "x", object) if kind in ("S1", str) else None
    elif how == "dims":
        dims = dims[::-1] if len(dims) > 1 else (pick(rng, [*group.dimensions, *dims, ""]),)
        dims, values = tuple(dim for dim in dims if dim in group.dimensions), None
    copy = group.createVariable(variable.name, kind, dims)
    copy.set_auto_maskandscale(False)
    for name in variable.ncattrs():
        if name != "_FillValue":
            copy.setncattr(name, variable.getncattr(name))
    if how == "attribute":
        names = ["units", "reduced_units", "long_name", "observable", "scale_factor"]
        copy.setncattr(pick(rng, names), pick(rng, VALUES))
    if values is not None and copy.size:
        if how == "value" and kind is not str and copy.dtype.kind == "f":
            values = np.array(values)
            values.flat[rng.integers(values.size)] = pick(rng, NUMBERS)
        copy[...] = values.astype(object) if kind is str else values


def foreign(rng, real, path):
    """Write a file of another program, or make a path that is no file."""
    name = pick(rng, [*FOREIGN])
    FOREIGN[name](rng, path)
    return f"foreign: {name}"


def netcdf_of_others(rng, path):
    """A dataset with names that the program knows, of any form."""
    form = pick(rng, ["NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_DATA", "NETCDF4_CLASSIC"])
    with netCDF4.Dataset(path, "w", format=form) as file:
        for dim in ("r", "beta", "seed", "sample", "particle", "axis"):
            file.createDimension(dim, pick(rng, [1, 2, 3]))
        names = "r beta n_seeds E_trans equilibrated R collisions kernel_seconds last_position"
        for name in names.split():
            dims = pick(rng, [(), ("r",), ("r", "beta"), ("seed",), ("particle", "axis")])
            file.createVariable(name, pick(rng, ["f8", "i4", "S1"]), dims)
        for name in "experiment scale dimension particles r beta seed study task".split():
            if rng.integers(5):
                attributes = {"experiment": "gas", "scale": "paper", "study": "x", "task": "x"}
                file.setncattr(
                    name, attributes.get(name, 1) if rng.integers(4) else pick(rng, VALUES)
                )


def netcdf_with_types(rng, path):
    """A dataset whose types are made of others."""
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("r", 2)
        pair = file.createCompoundType(np.dtype([("a", "f8"), ("b", "i4")]), "pair")
        list_type = file.createVLType("f8", "list")
        flags = file.createEnumType("u1", "flags", {"no": 0, "yes": 1})
        for name, kind in (("R", pair), ("E_trans", list_type), ("equilibrated", flags)):
            file.createVariable(name, kind, ("r",) if rng.integers(2) else ())
        for name in ("collisions", "kernel_seconds"):
            file.createVariable(name, "f8")
        attributes = {"experiment": "x", "scale": "x", "r": 0.9, "beta": 0.0, "seed": 1}
        file.setncatts(attributes | {"dimension": 2, "particles": 5})


def many_groups(rng, path):
    """Groups within groups."""
    with netCDF4.Dataset(path, "w") as file:
        for _ in range(int(rng.integers(1, 30))):
            file = file.createGroup("coverage")


def huge_variable(rng, path):
    """A small file that claims a huge variable."""
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("x", 10**12)
        file.createVariable("x", "f8", ("x",), chunksizes=(1000,))


def bomb(rng, path):
    """Write an archive with an array that claims to be huge."""
    head = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }"
    head = head.ljust(117) + b"\n"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("belongs to.npy", b"\x93NUMPY\x01\x00" + bytes([118, 0]) + head)


def objects(rng, path):
    """An archive with a pickle in it."""
    with path.open("wb") as file:
        np.savez(file, **{"belongs to": np.array([{"a": 1}], object)})


def sparse(rng, path):
    """A file that is longer than memory, and takes no place on a disk."""
    path.write_bytes(pick(rng, [b"", b"\x89HDF\r\n\x1a\n", b"CDF\x01"]))
    os.truncate(path, int(pick(rng, [5 * 10**9, 10**12])))


def loop(rng, path):
    target = path.with_name(f"{path.name}.other")
    path.symlink_to(target.name)
    target.symlink_to(path.name)


def bytes_of(make):
    return lambda rng, path: path.write_bytes(make(rng))


def packed(rng):
    file = io.BytesIO()
    np.savez(file, R=rng.random(3))
    return file.getvalue()


TEXTS = ["text", "é", "{}", "[]", "null", "3", '{"@graph": 3}', "a: [", "\0", "CDF\x01", "\x89HDF"]
FOREIGN = {
    "netCDF": netcdf_of_others,
    "netCDF of types": netcdf_with_types,
    "groups": many_groups,
    "huge variable": huge_variable,
    "bomb": bomb,
    "objects": objects,
    "sparse": sparse,
    "text": bytes_of(lambda rng: pick(rng, TEXTS).encode("latin-1")),
    "long line": bytes_of(lambda rng: b"x" * 100_000),
    "noise": bytes_of(lambda rng: rng.bytes(int(rng.integers(1, 5000)))),
    "HDF5 noise": bytes_of(lambda rng: b"\x89HDF\r\n\x1a\n" + rng.bytes(2000)),
    "netCDF noise": bytes_of(lambda rng: b"CDF" + bytes([rng.integers(1, 6)]) + rng.bytes(500)),
    "gzip": bytes_of(lambda rng: gzip.compress(rng.bytes(100))),
    "PNG": bytes_of(lambda rng: b"\x89PNG\r\n\x1a\n" + rng.bytes(300)),
    "pickle": bytes_of(lambda rng: pickle.dumps({"R": 1.0})),
    "npz": bytes_of(packed),
    "JSON": bytes_of(lambda rng: json.dumps({"experiment": "gas", "R": [1, 2]}).encode()),
    "empty": bytes_of(lambda rng: b""),
    "folder": lambda rng, path: path.mkdir(),
    "pipe": lambda rng, path: os.mkfifo(path),
    "dangling link": lambda rng, path: path.symlink_to("nothing"),
    "loop of links": loop,
    "endless device": lambda rng, path: path.symlink_to("/dev/zero"),
    "empty device": lambda rng, path: path.symlink_to("/dev/null"),
    "link to itself": lambda rng, path: path.symlink_to(path.name),
    "folder by link": lambda rng, path: path.symlink_to("."),
}
