# Which source files a result depends on. As inputs they make Snakemake redo what an edit may
# change, and nothing else.
import ast

PACKAGE = Path("src/roughgas")


def sources(*rooms):
    """Source files of these rooms of the package (modules or folders), and of those they import."""
    todo, found = list(rooms), {}
    while todo:
        room = todo.pop()
        if room not in found and (files := files_of(room)):
            found[room] = files
            todo += imported_rooms(files)
    return sorted(str(file) for files in found.values() for file in files)


@functools.cache
def files_of(room):
    """The files of a room; none where the package has no such room."""
    single = PACKAGE / f"{room}.py"
    return (single,) if single.exists() else tuple(sorted((PACKAGE / room).rglob("*.py")))


@functools.cache
def imported_rooms(files):
    """The rooms that files import from, anywhere in them."""
    rooms = set()
    for node in (node for file in files for node in ast.walk(ast.parse(file.read_bytes()))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        rooms |= {name.split(".")[1] for name in names if name.startswith("roughgas.")}
    return rooms
