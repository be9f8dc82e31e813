"""The machine code of a scene, as numba keeps it in its cache; and the same compiled where nothing
that the scene does without could be compiled at all.

As a program, `machine_code.py KERNEL [EFFECT ...]` prints what the kernel of that name (see
brute_force.scenes) is compiled to while every hook of all absent effects, and of those named, is
poisoned.
"""

import hashlib
import json
import sys

import llvmlite.binding as llvm
import numba
from brute_force import begin, run, settings
from numba.core.registry import cpu_target

from roughgas.compiling.jit import jit
from roughgas.effects import KINDS
from roughgas.kernel.hooks import Hooks
from roughgas.kernel.record import record


def sections(kernel, more=None):
    """The instructions and constants of a kernel, as bytes by the name of their section; `more` are
    other settings of the experiment.

    Without texts, which hold names of functions, into which numba writes how many it has compiled.
    """
    scene, state = begin(settings(kernel) | (more or {}), 0.9, -1.0)
    run(state, scene, 0)
    wanted = numba.typeof(state), numba.typeof(scene)
    signature = next(one for one in record.dispatcher.signatures if one[:2] == wanted)
    codegen = cpu_target.target_context.codegen()
    (_, _, (compiled, _)), *_ = record.dispatcher._cache.read(signature, codegen)
    found = {one.name(): one.data() for one in llvm.ObjectFileRef.from_data(compiled).sections()}
    kinds = (b".text", b".ltext", b".rodata.cst")
    return {name.decode(): bits for name, bits in found.items() if name and name.startswith(kinds)}


def checksums(kernel):
    """The same, as a length and a checksum of each section."""
    return {
        name: [len(bits), hashlib.sha256(bits).hexdigest()]
        for name, bits in sorted(sections(kernel).items())
    }


def poison(kind):
    """Replace every hook of an effect by a function that neither compiles nor runs."""

    @jit
    def poisoned(*arguments):
        return no_such_thing(*arguments)  # noqa: F821

    parts = kind.hooks._asdict()
    kind.hooks = Hooks(**{name: poisoned if callable(own) else own for name, own in parts.items()})


if __name__ == "__main__":
    kernel, *others = sys.argv[1:]
    effects = settings(kernel)["effects"]
    absent = {*KINDS.values()} - {KINDS[name] for name in effects}  # walls of all sides are a kind
    for kind in absent | {KINDS[name] for name in others}:
        poison(kind)
    print(json.dumps(checksums(kernel)))
