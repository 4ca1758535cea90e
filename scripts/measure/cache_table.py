"""The tables of scripts/measure/measure-cache, and the seconds that path tracing needs for the same error."""

import csv
import io
import math
import statistics

ERRORS = ("rel_mse_clean", "flip", "hdr_flip")


def equal_error_seconds(points, error):
    """The seconds for `error`, and whether it lies beyond the points. The points are (seconds, error), joined by straight lines
    on logarithmic axes. None if there are no two points, or if an error has no logarithm."""
    points = sorted((s, e) for s, e in points if s and e and s > 0 and e > 0)
    if len(points) < 2 or not error or error <= 0:
        return None, False
    pieces = list(zip(points, points[1:]))
    for (s0, e0), (s1, e1) in pieces:
        if e0 >= error >= e1 and e0 > e1:
            return on_piece(s0, e0, s1, e1, error), False
    (s0, e0), (s1, e1) = pieces[0] if error > points[0][1] else pieces[-1]
    # A line that does not fall cannot be extended.
    return (on_piece(s0, e0, s1, e1, error), True) if e0 > e1 and s0 < s1 else (None, True)


def on_piece(s0, e0, s1, e1, error):
    t = (math.log(error) - math.log(e0)) / (math.log(e1) - math.log(e0))
    return math.exp(math.log(s0) + t * (math.log(s1) - math.log(s0)))


def mean(rows, key):
    values = [row[key] for row in rows if row.get(key) is not None]
    return statistics.fmean(values) if values else None


def baseline_points(rows, scene, kind, key):
    """Seconds and error of the plain integrator at each of its sample counts: means over the pairs."""
    groups = {}
    for row in rows:
        if row["scene"] == scene and row["kind"] == kind and row["baseline"]:
            groups.setdefault(row["run"], []).append(row)
    return [(mean(group, "seconds"), mean(group, key)) for group in groups.values()]


def add_equal_error(rows):
    """Adds the columns to every row. They are empty for a baseline."""
    for row in rows:
        for key in ERRORS:
            points = baseline_points(rows, row["scene"], row["kind"], key)
            seconds, extrapolated = (None, False) if row["baseline"] else equal_error_seconds(points, row.get(key))
            row["equal_seconds_" + key] = seconds
            row["times_faster_" + key] = seconds / row["seconds"] if seconds and row["seconds"] else None
            row["extrapolated_" + key] = int(extrapolated) if seconds else None


def as_csv(rows):
    columns = []
    for row in rows:
        columns += [key for key in row if key not in columns]
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({key: "" if value is None else value for key, value in row.items()})
    return text.getvalue()


def cell(rows, key, pattern, scale=1.0):
    """The mean, and the standard deviation if the pairs differ."""
    values = [row[key] * scale for row in rows if row.get(key) is not None]
    if not values:
        return "-"
    text = pattern.format(statistics.fmean(values))
    if len(set(values)) > 1:
        text += " ± " + pattern.format(statistics.stdev(values))
    return text


def faster(rows, key):
    values = [row["times_faster_" + key] for row in rows if row.get("times_faster_" + key) is not None]
    if not values:
        return "-"
    mark = "*" if any(row.get("extrapolated_" + key) for row in rows) else ""
    # The geometric mean, because these are ratios.
    return f"{math.exp(statistics.fmean(map(math.log, values))):.2f}{mark}"


COLUMNS = [("run", "run", None, 1), ("spp", "spp", "{:.0f}", 1), ("steps", "steps", "{:.0f}", 1),
           ("train, s", "seconds_train", "{:.2f}", 1), ("render, s", "seconds_render", "{:.2f}", 1),
           ("all, s", "seconds", "{:.2f}", 1), ("cache, MiB", "memory_cache", "{:.1f}", 2.0 ** -20),
           ("rel. MSE", "rel_mse_clean", "{:.5f}", 1), ("bias²", "bias_rel_mse", "{:.5f}", 1),
           ("FLIP", "flip", "{:.4f}", 1), ("HDR-FLIP", "hdr_flip", "{:.4f}", 1)]
LEGEND = """Seconds: without loading, building and writing. Rel. MSE: of one picture, without the noise of the reference. bias²: the part
that would remain with infinitely many samples, from pairs of pictures. Times faster: the seconds that the plain integrator
needs for the same error, over those of the run; * if that lies beyond the measured sample counts."""


def as_markdown(rows):
    lines = [LEGEND]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        heads = [head for head, *_ in COLUMNS] + ["times faster: rel. MSE", "FLIP", "HDR-FLIP"]
        lines += ["", f"### {scene}", "", "| " + " | ".join(heads) + " |", "|---" + "|---:" * (len(heads) - 1) + "|"]
        groups = {}
        for row in rows:
            if row["scene"] == scene:
                groups.setdefault(row["run"], []).append(row)
        for run, group in groups.items():
            cells = [run if pattern is None else cell(group, key, pattern, scale)
                     for _, key, pattern, scale in COLUMNS]
            lines.append("| " + " | ".join(cells + [faster(group, key) for key in ERRORS]) + " |")
        for kind in dict.fromkeys(row["kind"] for row in rows if row["scene"] == scene):
            noise = mean([row for row in rows if (row["scene"], row["kind"]) == (scene, kind)], "reference_noise")
            if noise is not None:
                lines += ["", f"Noise of the reference of {kind}: {noise:.2g} in rel. MSE."]
    return "\n".join(lines) + "\n"
