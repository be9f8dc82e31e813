"""Settings are mappings in the functions listed here, where they enter; all other code takes
structs."""

import ast
import re
from pathlib import Path

import pytest

import roughgas

PACKAGE = Path(roughgas.__file__).parent
FUNCTIONS_WITH_RAW_SETTINGS = {
    "base.mappings.merged": "merges mappings",
    "base.labels.level_in": "looks up the value of a swept parameter",
    "config.experiment_of": "where Python's keyword arguments enter",
    "config.configuration._merged_keeping_none": "merges mappings of a file",
    "config.loading.load": "where the changes of a command line enter",
    "config.written.WrittenExperiment.changed": "where changes of an experiment enter",
    "library.simulate": "Python's keyword arguments",
    "library.trajectory": "Python's keyword arguments",
    "base.fields.read_each": "where settings of effects and of observables become structs",
    "scene.settings.scene_settings": "where a scene becomes a struct",
    "scene.settings.SceneSettings.changed": "where changes of a struct enter",
    "scene.settings.SceneSettings.with_effects": "where changes of effects enter",
    "simulation.experiment.Experiment.changed": "where changes of a struct enter",
    "simulation.experiment_reader.read_experiment": "where an experiment becomes a struct",
    "tasks.running.Experiments.__init__": "where the settings of a task enter",
}
"""The functions whose signatures have raw settings, and the reason."""
OTHER_MAPPINGS = {
    "Attributes": "of a dataset",
    "SettingsClasses": "of effects or observables, which are classes",
    "NamedValues": "that a function computes",
    "OwnSettings": "of a study, which has a JSON schema of its own",
    "Record": "of JSON, or a row of a table",
    "Schema": "a JSON schema",
    "Namespace": "the names of a module",
    "Style": "of matplotlib",
}
"""Names of mappings of text to anything that are no settings of an experiment, and their
content."""
RAW = r"\b(RawSettings|(Mapping|MutableMapping|dict|Dict)\[str, (Any|object)\])"


def modules():
    for path in sorted(PACKAGE.rglob("*.py")):
        name = ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")
        yield name, ast.parse(path.read_text(encoding="utf-8"))


def functions(tree, above):
    """Yield each function of a module or a class, by its full name."""
    for node in ast.iter_child_nodes(tree):
        name = f"{above}.{node.name}" if hasattr(node, "name") else above
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield name.removeprefix("."), node
        yield from functions(node, name)


def signature(function):
    """Return the annotations of a function's arguments and of its result, as text."""
    return ast.unparse(function.args) + " -> " + ast.unparse(function.returns or ast.Constant(None))


def aliases():
    """Yield the names of types that stand for a mapping of text to anything, of the whole
    package."""
    for _, tree in modules():
        for node in ast.walk(tree):
            is_alias = isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
            if is_alias and re.fullmatch(RAW.replace("RawSettings|", ""), ast.unparse(node.value)):
                yield node.targets[0].id


def test_raw_settings_are_in_the_listed_signatures_alone():
    functions_with_raw_settings = {
        name
        for module, tree in modules()
        for name, function in functions(tree, module)
        if re.search(RAW, signature(function))
    }
    assert (
        functions_with_raw_settings == {*FUNCTIONS_WITH_RAW_SETTINGS}
        and len(functions_with_raw_settings) <= 15
    )


def test_no_other_name_stands_for_raw_settings():
    assert {*aliases()} == {"RawSettings", *OTHER_MAPPINGS}


@pytest.mark.parametrize(
    "text", ["dict[str, Any]", "Mapping[str, Any] | None", "list[RawSettings]"]
)
def test_an_unlisted_function_is_found(text):
    (function,) = functions(ast.parse(f"class A:\n    def f(self, x: {text}): ..."), "m")
    assert function[0] == "m.A.f" and re.search(RAW, signature(function[1]))
