"""The section of RESULTS.md on caches as guides of reconstruction, from data/results/guides.csv.

    results_guides.py DIR/results.csv > data/results/guides.csv

cuts a measurement by cache-guides.plan down to the columns that the section shows."""

import csv
import os
import sys

import cache_table
import results_tables as tables
from measured_scenes import SCENES

COLUMNS = ("scene", "size", "run", "pair", "threads", "isa", "version", "seconds", "rel_mse_clean", "flip", "memory_parameters")
RUNS = ("bare, 512 steps", "preview", "standard", "final")
HEAD = """## What reconstruction changes: the caches as guides

A finished picture takes the shape of the cache's light and not its values (`renderer/reconstruction/README.md`). Here both encodings guide the
presets, which end paths in them, too: seconds of all phases; relative MSE without the noise of the reference, FLIP. Pictures of {size}, {pictures}
for each figure (`scripts/measure/measure-cache --plan scripts/measure/cache-guides.plan`, Gatelight {version}, {threads} threads, {isa}).

"""


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [{key: row[key] for key in COLUMNS} for row in csv.DictReader(file)]


def cell(rows):
    numbers = [{key: float(row[key]) for key in ("seconds", "rel_mse_clean", "flip")} for row in rows if row["flip"]]
    if not numbers:
        return "failed"
    seconds, rel_mse, flip = (cache_table.mean(numbers, key) for key in ("seconds", "rel_mse_clean", "flip"))
    return f"{seconds:.1f} s; {rel_mse:.4f}, {flip:.3f}"


def sections(folder):
    """One, or none where the figures are missing."""
    path = os.path.join(folder, "guides.csv")
    if not os.path.exists(path):
        return []
    rows = read(path)
    by_run = cache_table.groups_by(rows, "scene", "run")
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        for encoding, prefix in (("GATE", ""), ("hash grid", "hashgrid ")):
            groups = [by_run.get((scene, prefix + run), []) for run in RUNS]
            memory = max((float(row["memory_parameters"] or 0) for group in groups for row in group), default=0.0) / 2**20
            lines.append([SCENES[scene].title, encoding, f"{memory:.1f}", *map(cell, groups)])
    pairs = len({row["pair"] for row in rows})
    return [HEAD.format(pictures="two seeds" if pairs == 1 else f"{2 * pairs} seeds", **rows[0]) + tables.table(
        ["scene", "guide", "MiB", "bare cache, 512 steps", "`preview`", "`standard`", "`final`"], lines)]


def main(source):
    writer = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(row for row in read(source) if row["run"].removeprefix("hashgrid ") in RUNS)


if __name__ == "__main__":
    main(*sys.argv[1:])
