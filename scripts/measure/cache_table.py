"""The tables of scripts/measure/measure-cache, and the seconds that path tracing needs for the same error."""

import csv
import io
import itertools
import math
import statistics

from measured_scenes import SCENES

ERRORS = ("rel_mse_clean", "flip", "hdr_flip")
# The plain integrator as traced and denoised, and the columns of the seconds that it needs for the same error.
BASELINES = {"plain": "", "denoised": "denoised_"}


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


def groups_by(rows, *keys):
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def baseline_points(rows, like, baseline, key):
    """Seconds and error of a baseline of this row, at each of its sample counts: means over the pairs."""
    own = [row for row in rows if row["baseline"] == baseline and all(row[k] == like[k] for k in ("scene", "size", "kind"))]
    return [(mean(group, "seconds"), mean(group, key)) for group in groups_by(own, "run").values()]


def add_equal_error(rows):
    """Adds the columns to every row. A baseline's row only has those of the baselines before it."""
    names = list(BASELINES)
    for row in rows:
        less = names[:names.index(row["baseline"])] if row["baseline"] else names
        for baseline, key in itertools.product(names, ERRORS):
            points = baseline_points(rows, row, baseline, key) if baseline in less else []
            seconds, extrapolated = equal_error_seconds(points, row.get(key))
            column = BASELINES[baseline] + key
            row["equal_seconds_" + column] = seconds
            row["times_faster_" + column] = seconds / row["seconds"] if seconds and row["seconds"] else None
            row["extrapolated_" + column] = int(extrapolated) if seconds else None


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
        return ""
    text = pattern.format(statistics.fmean(values))
    if len(set(values)) > 1:
        text += " ± " + pattern.format(statistics.stdev(values))
    return text


def faster_of(rows, key):
    values = [row["times_faster_" + key] for row in rows if row.get("times_faster_" + key) is not None]
    if not values:
        return ""
    mark = "*" if any(row.get("extrapolated_" + key) for row in rows) else ""
    # The geometric mean, because these are ratios.
    return f"{math.exp(statistics.fmean(map(math.log, values))):.2g}{mark}"


def faster(rows, baseline):
    texts = [faster_of(rows, BASELINES[baseline] + key) for key in ("rel_mse_clean", "flip")]
    return "; ".join(text or "-" for text in texts) if any(texts) else ""


COLUMNS = [("seconds", "seconds", "{:.1f}", 1), ("rel. MSE", "rel_mse_clean", "{:.4f}", 1), ("bias²", "bias_rel_mse", "{:.4f}", 1),
           ("FLIP", "flip", "{:.3f}", 1)]
HEADS = ["", "", *(head for head, *_ in COLUMNS), "times faster than plain: rel. MSE; FLIP", "than plain denoised"]
LEGEND = """Seconds: all phases (scouting, training, rendering, denoising), without loading, building and writing. Rel. MSE: of one
picture, without the noise of the reference. bias²: the part that would remain with infinitely many samples, from pairs of
pictures. Times faster: the seconds that the plain integrator needs for the same error, as traced and denoised, over those
of the run; * if that lies beyond the measured sample counts. results.csv has all figures."""


def short(value, pattern):
    """Formats a number without the zero before the point."""
    text = pattern.format(value)
    return text[1:] if text.startswith("0.") else text


def as_trade(rows):
    """A row for each scene, a column for each denoised run: seconds, relative MSE, FLIP, and how many times less time than denoised
    paths these are in relative MSE and FLIP."""
    shown = [row for row in rows if row["baseline"] != "plain" and row.get("flip") is not None]
    if not shown:
        return []
    runs = list(dict.fromkeys(row["run"] for row in shown))
    lines = ["| | " + " | ".join(runs) + " |", "|---" * (len(runs) + 1) + "|"]
    for (scene, size), group in groups_by(shown, "scene", "size").items():
        cells = [f"{SCENES[scene].title}, {size}"]
        for run in runs:
            own = [row for row in group if row["run"] == run]
            if not own:
                cells.append("")
                continue
            text = f"{mean(own, 'seconds'):.1f} s, {short(mean(own, 'rel_mse_clean'), '{:.4f}')}, {short(mean(own, 'flip'), '{:.3f}')}"
            times = faster(own, "denoised")
            cells.append(f"{text} ({times})" if times else text)
        lines.append("| " + " | ".join(cells) + " |")
    return lines + [""]


def as_markdown(rows):
    lines = [*as_trade(rows), LEGEND, "", "| " + " | ".join(HEADS) + " |", "|---|---" + "|---:" * (len(HEADS) - 2) + "|"]
    before = None
    for (scene, size, run), group in groups_by(rows, "scene", "size", "run").items():
        name = f"{SCENES[scene].title}, {size}"
        cells = ["" if name == before else name, run] + [cell(group, key, pattern, scale) for _, key, pattern, scale in COLUMNS]
        lines.append("| " + " | ".join(cells + [faster(group, baseline) for baseline in BASELINES]) + " |")
        before = name
    noises = []
    for (scene, size, kind), group in groups_by(rows, "scene", "size", "kind").items():
        noise = mean(group, "reference_noise")
        if noise is not None:
            noises.append(f"{SCENES[scene].title}, {size}, {kind}: {noise:.2g}")
    return "\n".join(lines + ["", "Noise of the references in rel. MSE: " + "; ".join(noises) + "."]) + "\n"
