"""The safety net reports all differences, and nothing else: see tests/net."""

import json

from tests.bits import CLOCKS
from tests.net.command import compare, difference_lines, file_of, main
from tests.net.recorders import description_of, simulations

from roughgas.observables import OBSERVABLES


def test_only_a_planted_difference_is_reported(tmp_path, capsys):
    arguments = [str(tmp_path), "--only", "help"]
    assert main(["record", *arguments]) == 0
    assert main(["compare", *arguments]) == 0
    path = file_of(tmp_path, "help")
    texts = json.loads(path.read_text("utf-8"))
    texts["steps table"] = texts["steps table"].replace("row", "line")
    path.write_text(json.dumps(texts), "utf-8")
    capsys.readouterr()
    assert main(["compare", *arguments]) == 1
    lines = capsys.readouterr().out.splitlines()
    changed = [line for line in lines if line.startswith(("+Write", "-Write"))]
    assert lines[0] == "help: steps table" and lines[-1] == f"help: 1 of {len(texts)} items differ"
    assert [" line" in line for line in changed] == [True, False]


def test_a_common_difference_is_printed_once_with_its_items(tmp_path, capsys):
    old = {f"{name}": json.dumps({"settings": '{"box":[1,2]}', "name": name}) for name in "abc"}
    new = {name: text.replace("2", "2.0") for name, text in old.items()} | {"d": ""}
    for folder, texts in (("before", old), ("now", new)):
        (tmp_path / folder).mkdir()
        file_of(tmp_path / folder, "part").write_text(json.dumps(texts), "utf-8")
    assert compare("part", tmp_path / "before", tmp_path / "now") == 4
    output = capsys.readouterr().out
    assert output.count("+    2.0") == 1 and "the same in 2 more:\n  b\n  c\n" in output
    assert "part: d\n--- (absent)" in output


def test_texts_with_different_spellings_of_json_differ():
    assert difference_lines('{"a":1}', '{"a": 1}') and difference_lines(
        '{"a":1,"b":2}', '{"b":2,"a":1}'
    )
    assert difference_lines("a\n", "a") and not difference_lines("a", "a")


def test_the_record_of_a_dataset_has_names_attributes_dimensions_and_values(files):
    content = json.loads(description_of(files["point"]))
    assert content["attributes"]["seed"] == "3" and content["dimensions"]["source"] == 2
    assert content["variables"]["R_series"]["dimensions"] == ["sample"]
    assert content["variables"]["R"]["attributes"]["units"] == "1"
    without = [name for name, texts in content["variables"].items() if "values" not in texts]
    assert without == [*CLOCKS]


def test_simulations_have_all_observables_and_kinds_of_schedules():
    gases = simulations().values()
    assert {name for _, observables in gases for name in observables} == {*OBSERVABLES}
    assert {gas_settings["schedule"]["kind"] for gas_settings, _ in gases} == {
        "steady",
        "cooling",
        "stages",
    }
