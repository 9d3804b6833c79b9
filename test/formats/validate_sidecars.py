#!/usr/bin/python3
"""Checks the sidecars that the library writes against doc/demonstration.schema.json, and the schema itself:
it must know every key that is written, accept the least a sidecar may hold, and refuse what is wrong."""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

from jsonschema import Draft7Validator

MINIMAL = {"format": "demo_logger/1", "columns": [{"name": "time"}, {"name": "q_elbow"}]}

# What is changed in the full sidecar, and to what it must not be changed.
WRONG = [
    (["format"], "demo_logger/2"),
    (["channel"], "telepathy"),
    (["outcome"], "maybe"),
    (["status"], "interrupted"),
    (["id"], "../../etc/passwd"),
    (["rows"], -1),
    (["duration"], "2.5 s"),
    (["start_stamp"], 1600000000.5),
    (["start_stamp", "nsecs"], 1000000000),
    (["columns", 1, "name"], "q elbow"),
    (["columns", 1, "name"], "q" * 64),
    (["columns", 1, "role"], "observation"),
    (["columns", 1, "interpolation"], "cubic"),
    (["robot", "joints"], "elbow"),
    (["effort", "side"], "left"),
    (["effort", "timing"], "later"),
    (["teleop_map", "gain"], [0.5, 0.25]),
    (["streams", 0, "stamped"], "no"),
    (["streams", 0, "align"], "previous"),
    (["counters", "late_rows"], 0.5),
    (["faults", 0, "what"], None),
    (["faults", 0, "severity"], "grave"),
    (["parameters", "joints"], {"a": 1}),
    (["provenance", "steps"], "resample"),
]


def undocumented(value, schema, definitions, path=""):
    """Keys that are written but have no place in the schema."""
    if "$ref" in schema:
        schema = definitions[schema["$ref"].split("/")[-1]]
    for choice in schema.get("oneOf", []):
        if choice.get("type") == "object" and isinstance(value, dict):
            schema = choice
    if isinstance(value, list):
        return [key for item in value for key in undocumented(item, schema.get("items", {}), definitions, path + "[]")]
    missing = []
    if isinstance(value, dict) and "properties" in schema:
        for key, item in value.items():
            if key not in schema["properties"]:
                missing.append(f"{path}.{key}")
            else:
                missing += undocumented(item, schema["properties"][key], definitions, f"{path}.{key}")
    return missing


def changed(sidecar, path, value):
    result = copy.deepcopy(sidecar)
    target = result
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    return result


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    Draft7Validator.check_schema(schema)
    validator = Draft7Validator(schema)
    failures = []

    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[2], folder], check=True)
        sidecars = {path.name: json.loads(path.read_text(encoding="utf-8"))
                    for path in sorted(pathlib.Path(folder).iterdir())}
    if sorted(sidecars) != ["default.json", "full.json"]:
        failures.append(f"expected two sidecars, found {sorted(sidecars)}")

    sidecars["minimal"] = MINIMAL
    for name, sidecar in sidecars.items():
        failures += [f"{name}: {error.message} at {list(error.path)}" for error in validator.iter_errors(sidecar)]
        failures += [f"{name}: key {key} is written but not in the schema"
                     for key in undocumented(sidecar, schema, schema["definitions"]) if key != ".lab"]
    for path, value in WRONG:
        if validator.is_valid(changed(sidecars["full.json"], path, value)):
            failures.append(f"the schema accepts {path} = {value!r}")
    if validator.is_valid({}):
        failures.append("the schema accepts a sidecar without `format`")

    print("\n".join(failures) or f"{len(sidecars)} sidecars valid, {len(WRONG) + 1} wrong ones refused")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
