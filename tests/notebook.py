"""The outputs of docs/tutorial.ipynb.

`python -m tests.notebook` runs the notebook, after `make docs`, which installs what that needs, and
writes its outputs into it. `make docs` runs it, too, and compares texts; figures may differ with
the version of matplotlib.
"""

import json
from pathlib import Path

NOTEBOOK = Path(__file__).parents[1] / "docs" / "tutorial.ipynb"
OUTPUT_FORMS = ("text/plain", "image/png")
"""Forms of an output that are kept: HTML of datasets has random identifiers."""


def read(path=NOTEBOOK):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def code_cells(notebook):
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def text_of(lines):
    """Return a text that a notebook stores as a text or as a list of lines."""
    return lines if isinstance(lines, str) else "".join(lines)


def kept_outputs(cell):
    """Return the outputs of a cell without times, errors, HTML and finished bars of progress."""
    outputs = []
    for output in cell["outputs"]:
        if output["output_type"] == "stream":
            if output["name"] == "stdout":
                outputs.append({**output, "text": text_of(output["text"])})
            continue
        data = {
            form: text_of(output["data"][form]) for form in OUTPUT_FORMS if form in output["data"]
        }
        if "".join(data.values()):
            outputs.append({**output, "data": data, "metadata": {}})
    return outputs


def texts(notebook):
    """Return, for each code cell, the texts of its outputs that every machine repeats."""
    return [
        [output.get("text") or output["data"]["text/plain"] for output in kept_outputs(cell)]
        for cell in code_cells(notebook)
    ]


def with_outputs(written, executed):
    """Return the notebook `written` with the outputs of the same cells in `executed`."""
    for cell, done in zip(code_cells(written), code_cells(executed), strict=True):
        cell["execution_count"] = done["execution_count"]
        cell["outputs"] = kept_outputs(done)
        cell["metadata"] = {}
    return written


def execute(path=NOTEBOOK):
    """Return the notebook at `path` as a kernel of Jupyter has run it."""
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, kernel_name="python3").execute(cwd=str(path.parent))
    return json.loads(nbformat.writes(notebook))


if __name__ == "__main__":
    notebook = with_outputs(read(), execute())
    NOTEBOOK.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
