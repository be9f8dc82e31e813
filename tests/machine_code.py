"""The machine code of a scene, as numba keeps it in its cache; and the same compiled where nothing
that the scene does without could be compiled at all.

As a program, `machine_code.py KERNEL [FILE ...]` prints what the kernel of that name (see
brute_force.scenes) is compiled to while every function in the files of all absent effects, and in
those named, is poisoned.
"""

import hashlib
import json
import sys

import llvmlite.binding as llvm
import numba
from brute_force import begin, run, settings
from numba.core.registry import cpu_target

from roughgas.kernel.jit import jit
from roughgas.kernel.record import record


def sections(kernel):
    """The instructions and constants of a kernel, as bytes by the name of their section.

    Without texts, which hold names of functions, into which numba writes how many it has compiled.
    """
    scene, state = begin(settings(kernel), 0.9, -1.0)
    run(state, scene, 0)
    wanted = numba.typeof(state), numba.typeof(scene)
    signature = next(one for one in record.signatures if one[:2] == wanted)
    key = record._cache._index_key(signature, cpu_target.target_context.codegen())
    (_, _, (compiled, _)), *_ = record._cache._cache_file.load(key)
    found = {one.name(): one.data() for one in llvm.ObjectFileRef.from_data(compiled).sections()}
    kinds = (b".text", b".ltext", b".rodata.cst")
    return {name.decode(): bits for name, bits in found.items() if name and name.startswith(kinds)}


def checksums(kernel):
    """The same, as a length and a checksum of each section."""
    return {
        name: [len(bits), hashlib.sha256(bits).hexdigest()]
        for name, bits in sorted(sections(kernel).items())
    }


def absent(scene):
    """The modules of roughgas.effects of no effect in the scene, nor used by one that is there."""
    there = {type(effect).__module__ for effect in scene.effects if effect is not None}
    there |= {
        getattr(value, "__module__", "")
        for module in there
        for value in vars(sys.modules[module]).values()
        if not isinstance(value, type)
    }
    every = {name for name in sys.modules if name.startswith("roughgas.effects.")}
    return every - there - {"roughgas.effects.settings"}


def poison(module):
    """Replace every function of a module by one that neither compiles nor runs."""

    @jit
    def poisoned(*arguments):
        return no_such_thing(*arguments)  # noqa: F821

    for name, value in list(vars(module).items()):
        if callable(value) and not isinstance(value, type):
            setattr(module, name, poisoned)


if __name__ == "__main__":
    kernel, *others = sys.argv[1:]
    scene, _ = begin(settings(kernel), 0.9, -1.0)
    for name in absent(scene) | {f"roughgas.effects.{file}" for file in others}:
        poison(sys.modules[name])
    print(json.dumps(checksums(kernel)))
