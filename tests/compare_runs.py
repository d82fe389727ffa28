"""Compares two run folders by what they hold, whatever version of the program wrote them.

    python3 tests/compare_runs.py OLD NEW

Nets are compared as bytes, tables row by row: numbers by their bits, text as text, columns by name. Needs `pyarrow`.
Exit code 0 where all is equal, 1 where anything differs.
"""

import json
import pathlib
import struct
import sys

import pyarrow.parquet


def nets(folder: pathlib.Path) -> dict[str, bytes]:
    """Bytes of every tensor, by file and name."""
    found = {}
    for path in sorted((folder / "skills").glob("**/*.safetensors")):
        data = path.read_bytes()
        (length,) = struct.unpack("<Q", data[:8])
        for name, entry in json.loads(data[8 : 8 + length]).items():
            if name != "__metadata__":
                start, end = entry["data_offsets"]
                found[f"{path.name}: {name}"] = data[8 + length + start : 8 + length + end]
    return found


def bits(value: object) -> object:
    """A value that is equal where the bits are."""
    return struct.pack("<d", value) if isinstance(value, float) else value


def table(path: pathlib.Path) -> list[tuple]:
    """Rows of a table, sorted, each as (column, value) by column name."""
    rows = pyarrow.parquet.read_table(path).to_pylist()
    return sorted((tuple((name, bits(row[name])) for name in sorted(row)) for row in rows), key=repr)


def main() -> int:
    old, new = map(pathlib.Path, sys.argv[1:3])
    different = 0
    left, right = nets(old), nets(new)
    for name in sorted(left.keys() | right.keys()):
        if left.get(name) != right.get(name):
            different += 1
            print(f"tensor {name} differs")
    print(f"{len(left)} and {len(right)} tensors")
    for name in ("trials.parquet", "evaluations.parquet"):
        rows = table(old / name), table(new / name)
        if rows[0] != rows[1]:
            different += 1
            first = next((pair for pair in zip(*rows) if pair[0] != pair[1]), None)
            print(f"{name} differs: {len(rows[0])} and {len(rows[1])} rows; first {first}")
        print(f"{name}: {len(rows[0])} and {len(rows[1])} rows")
    print("equal" if different == 0 else f"{different} differences")
    return min(different, 1)


if __name__ == "__main__":
    sys.exit(main())
