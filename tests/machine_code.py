"""The machine code of a scene's kernel in numba's cache, also with every absent effect poisoned.

As a program, `machine_code.py KERNEL [EFFECT ...]` prints the machine code of the kernel of that
name (see brute_force.scenes) while every hook of all absent effects, and of those named, is
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
from roughgas.effects import EFFECTS
from roughgas.kernel.hooks import Hooks
from roughgas.kernel.record import record


def sections(kernel, extra=None):
    """Return the instructions and constants of a kernel, as bytes by the name of their section;
    `extra` are other settings of the experiment.

    Without texts, which hold names of functions, into which numba writes how many it has compiled.
    """
    scene, state = begin(settings(kernel) | (extra or {}), 0.9, -1.0)
    run(state, scene, 0)
    argument_types = numba.typeof(state), numba.typeof(scene)
    signature = next(
        signature_or_section
        for signature_or_section in record.dispatcher.signatures
        if signature_or_section[:2] == argument_types
    )
    codegen = cpu_target.target_context.codegen()
    (_, _, (compiled, _)), *_ = record.dispatcher._cache.read(signature, codegen)
    found = {
        signature_or_section.name(): signature_or_section.data()
        for signature_or_section in llvm.ObjectFileRef.from_data(compiled).sections()
    }
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
    absent = {*EFFECTS.values()} - {
        EFFECTS[name] for name in effects
    }  # walls of all sides are a kind
    for kind in absent | {EFFECTS[name] for name in others}:
        poison(kind)
    print(json.dumps(checksums(kernel)))
