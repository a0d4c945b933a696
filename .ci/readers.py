"""Reads what `.ci/readers` let the program write; an assertion that fails is a file that others can't read."""

import copy
import glob
import json
import sys
import tomllib

import jsonschema
import meshio
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

folder, scene_path, scenarios = sys.argv[1:]


def read_csv(path):
    """A table with its numbers as they are written: what pandas does by itself from version 3 on."""
    exact = {} if int(pd.__version__.split(".")[0]) >= 3 else {"float_precision": "round_trip"}
    return pd.read_csv(path, **exact)


def parquet():
    table = pq.read_table(f"{folder}/sweep/results.parquet")
    csv = read_csv(f"{folder}/sweep/results.csv")
    assert table.column_names == list(csv.columns), table.column_names
    types = {name: table.schema.field(name).type for name in table.column_names}
    double = ["block.rocker.tilt", "contact.feet.friction", "largest", "impacts"]
    assert all(types[name] == pa.float64() for name in double), types
    assert types["case"] == types["unsolved_steps"] == pa.int64(), types
    assert types["status"] == types["error"] == pa.string(), types
    assert table.num_rows == len(csv) == 6
    for name in double + ["case"]:
        typed = table.column(name).to_pandas().to_numpy(dtype=float)
        assert np.array_equal(typed, csv[name].to_numpy(dtype=float), equal_nan=True), name
    status = table.column("status").to_pylist()
    assert status == list(csv["status"]) and set(status) == {"complete", "refused"}, status
    assert table.column("largest").null_count == 3 and table.column("error").null_count == 3
    units = json.loads(table.schema.metadata[b"units"])
    assert units == {"block.rocker.tilt": "rad", "largest": "rad"}, units
    return f"{table.num_rows} rows, {len(types)} typed columns, units {units}"


def vtk():
    rows = read_csv(f"{folder}/run/trajectory.csv")
    pictures = sorted(glob.glob(f"{folder}/run/vtk/*.vtu"))
    assert len(pictures) == len(rows) > 100
    # meshio checks every index and the length of every array.
    for number in range(0, len(pictures), 25):
        mesh = meshio.read(pictures[number])
        corners = mesh.points[next(cell.data[0] for cell in mesh.cells if cell.data.shape[1] == 4)]
        centre = rows.loc[number, ["rocker.x", "rocker.y"]].to_numpy(dtype=float)
        assert np.allclose(corners.mean(axis=0)[:2], centre, rtol=0, atol=1e-12), (number, centre)
    return f"{len(pictures)} pictures, the mass centre in each 25th"


def schema():
    with open(f"{folder}/schema.json") as file:
        text = json.load(file)
    cls = jsonschema.validators.validator_for(text)
    cls.check_schema(text)
    validator = cls(text)
    names = sorted(glob.glob(f"{scenarios}/*.toml"))
    for name in names:
        with open(name, "rb") as file:
            validator.validate(tomllib.load(file))
    with open(scene_path, "rb") as file:
        good = tomllib.load(file)
    wrong = {
        "a bare number for a time": lambda scene: scene["time"].update(end=1.0),
        "another dimension": lambda scene: scene["block"]["rocker"].update(width="3 kg"),
        "an unknown key": lambda scene: scene["block"]["rocker"].update(colour="red"),
        "an unknown table": lambda scene: scene.update(contacts={}),
        "a missing key": lambda scene: scene["time"].pop("end"),
        "an unknown word": lambda scene: scene["time"].update(scheme="euler"),
    }
    for what, spoil in wrong.items():
        scene = copy.deepcopy(good)
        spoil(scene)
        assert not validator.is_valid(scene), f"{what} is accepted"
    return f"{len(names)} scenes accepted, {len(wrong)} wrong ones refused"


def tables():
    read = []
    with open(f"{folder}/run/columns.json") as file:
        for name, columns in json.load(file).items():
            table = read_csv(f"{folder}/run/{name}")
            assert list(table.columns) == [column for column, _ in columns], name
            for column, unit in columns:
                assert not unit or table[column].dtype.kind in "fi", (name, column, table[column].dtype)
            read.append(name)
    assert "trajectory.csv" in read
    trajectory = read_csv(f"{folder}/run/trajectory.csv")
    assert trajectory["t"].is_monotonic_increasing and np.isfinite(trajectory.to_numpy()).all()
    for name in glob.glob(f"{folder}/compare/*.csv"):
        table = read_csv(name)
        assert len(table) and not any(column.startswith("Unnamed") for column in table.columns), name
        read.append(name.rsplit("/", 1)[1])
    cycles = read_csv(next(iter(glob.glob(f"{folder}/compare/*cycles*.csv"))))
    numbers = cycles.select_dtypes("number")
    assert numbers.shape[1] >= 3 and len(cycles) >= 2, cycles
    return ", ".join(read)


print("parquet:", parquet())
print("vtk:", vtk())
print("schema:", schema())
print("tables:", tables())
