"""The machine code of the kernel's entry, as it lies in the cache of compiled kernels."""

import llvmlite.binding as llvm
from numba.core.registry import cpu_target

from roughgas.kernel.record import record


def machine_code(scene):
    """Bytes of the instructions and constants of the entry that was compiled for a scene last run.

    The names in it are left out: numba counts the functions that it compiles.
    """
    signature = next(one for one in reversed(record.signatures) if str(one[1]) == scene)
    cache = record._cache
    key = cache._index_key(signature, cpu_target.target_context.codegen())
    (_, _, (compiled, _)), *_ = cache._cache_file.load(signature, key)
    sections = llvm.ObjectFileRef.from_data(compiled).sections()
    found = {one.name(): one.data() for one in sections}
    return {k: v for k, v in found.items() if k and k.startswith((".text", ".rodata"))}
