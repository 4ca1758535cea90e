"""Reads the figures of scripts/measure/measure-paper (data/results/NAME.csv) and compares their means over the seeds."""

import csv
import json
import math
import os
import statistics

MIB = 2.0**20


class Group:
    """The seeds of one configuration."""

    def __init__(self, cells):
        self.cells = cells

    def values(self, column):
        return [float(cell[column]) for cell in self.cells if cell[column] != ""]

    def mean(self, column):
        values = self.values(column)
        return statistics.fmean(values) if values else None

    def median(self, column):
        """For times, because some run may be disturbed."""
        values = self.values(column)
        return statistics.median(values) if values else None

    def deviation(self, column):
        values = self.values(column)
        return statistics.stdev(values) if len(values) > 1 else None

    def error_of_mean(self, column):
        deviation = self.deviation(column)
        return None if deviation is None else deviation / math.sqrt(len(self.values(column)))

    def mebibytes(self):
        mean = self.mean("parameter_bytes")
        return None if mean is None else mean / MIB


class Results:
    """The figures of one experiment. Points are training steps, or samples of path tracing."""

    def __init__(self, folder, name):
        with open(os.path.join(folder, name + ".csv"), encoding="utf-8", newline="") as file:
            self.cells = list(csv.DictReader(file))
        with open(os.path.join(folder, name + ".json"), encoding="utf-8") as file:
            self.about = json.load(file)
        self.groups = {}
        for cell in self.cells:
            key = (cell["scene"], cell["integrator"], cell["row"], int(cell["steps"] or cell["spp"]))
            self.groups.setdefault(key, []).append(cell)
        self.groups = {key: Group(cells) for key, cells in self.groups.items()}

    def scenes(self):
        return list(dict.fromkeys(key[0] for key in self.groups))

    def rows(self, integrator):
        return list(dict.fromkeys(key[2] for key in self.groups if key[1] == integrator))

    def steps(self):
        return sorted({key[3] for key in self.groups if key[1] != "path"})

    def get(self, scene, integrator, row, steps=128):
        return self.groups.get((scene, integrator, row, steps))

    def seeds(self):
        return len({cell["seed"] for cell in self.cells})


def difference(a, b, column):
    """-1 if a is lower, 1 if b is lower, 0 if they differ by less than two standard errors; None without figures."""
    mean_a, mean_b = a.mean(column), b.mean(column)
    if mean_a is None or mean_b is None:
        return None
    errors = [group.error_of_mean(column) or 0.0 for group in (a, b)]
    if abs(mean_a - mean_b) <= 2.0 * math.hypot(*errors):
        return 0
    return -1 if mean_a < mean_b else 1
