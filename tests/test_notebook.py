"""The tutorial is committed with its outputs; `make docs` runs it and compares them."""

from tests import notebook

TUTORIAL = notebook.read()
CELLS = notebook.code_cells(TUTORIAL)
LARGEST = 300_000  # bytes
PNG = "iVBORw0KGgo"  # as base64


def test_every_cell_has_run_and_shows_its_outputs():
    assert [cell["execution_count"] for cell in CELLS] == [*range(1, len(CELLS) + 1)]
    assert all(cell["outputs"] for cell in CELLS)
    images = [
        output["data"]["image/png"]
        for cell in CELLS
        for output in cell["outputs"]
        if "image/png" in output.get("data", {})
    ]
    assert len(images) >= 4 and all(image.startswith(PNG) for image in images)


def test_its_outputs_are_small_and_without_times_and_progress():
    assert notebook.NOTEBOOK.stat().st_size < LARGEST
    for cell in CELLS:
        assert cell["metadata"] == {} and cell["outputs"] == notebook.kept_outputs(cell)
    assert all(
        text and "\r" not in text for of_cell in notebook.texts(TUTORIAL) for text in of_cell
    )


def test_outputs_of_a_run_are_cleaned():
    stream = {"output_type": "stream", "name": "stdout", "text": ["a\n", "b\n"]}
    error = {**stream, "name": "stderr"}
    bar = {"output_type": "display_data", "metadata": {"a": 1}, "data": {"text/plain": ""}}
    table = {**bar, "data": {"text/plain": ["1"], "text/html": "<p id=random>"}}
    cell = {"cell_type": "code", "outputs": [error, stream, bar, table], "execution_count": 1}
    cell["metadata"] = {"execution": {"iopub.status.busy": "2026"}}
    written = {"cells": [{"cell_type": "markdown"}, {**cell, "outputs": []}]}
    cleaned = notebook.with_outputs(written, {"cells": [cell]})
    assert notebook.texts(cleaned) == [["a\nb\n", "1"]]
    assert cleaned["cells"][1]["metadata"] == {}
    assert cleaned["cells"][1]["outputs"][1]["data"] == {"text/plain": "1"}
