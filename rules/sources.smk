# Which source files a result depends on. As inputs they make Snakemake redo what an edit may
# change, and nothing else.
import ast

SOURCE = Path("src")


def sources(*modules):
    """Source files of these modules of the package, such as "simulation.point", of the packages
    that they are in, and of all that they import."""
    todo, found = [f"roughgas.{name}" for name in modules], {}
    while todo:
        name = todo.pop()
        if name not in found and (file := file_of(name)):
            found[name] = file
            todo += [*imported_modules(file), *submodules(name), name.rpartition(".")[0]]
    return sorted(str(file) for file in found.values())


@functools.cache
def file_of(module):
    """The file of a module; None where there is none of that name."""
    path = SOURCE.joinpath(*module.split("."))
    files = (path.with_suffix(".py"), path / "__init__.py")
    return next((file for file in files if module and file.exists()), None)


@functools.cache
def submodules(module):
    """Those that a package imports by names made at run time: see IMPORTED_BY_NAME."""
    folder = SOURCE.joinpath(*module.split("."))
    if module not in IMPORTED_BY_NAME:
        return ()
    return tuple(f"{module}.{file.stem}" for file in sorted(folder.glob("*.py")))


IMPORTED_BY_NAME = ("roughgas.studies.figures", "roughgas.studies.accuracy")


@functools.cache
def imported_modules(file):
    """The modules that a file imports from, anywhere in it."""
    modules = set()
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return {module for module in modules if module.startswith("roughgas.")}
