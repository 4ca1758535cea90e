"""Markdown tables of the paper's experiments; each function takes Results of an experiment."""

from measured_scenes import title_of

WORDS = {"nao": "Neural ambient occlusion (`nao`)", "nrc": "Neural radiance caching (`nrc`)"}


def number(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def significant(value):
    """Three digits."""
    if value is None:
        return ""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}" if value < 1 else f"{value:.2f}" if value < 10 else f"{value:.1f}"


def with_deviation(group, column):
    """Mean and standard deviation over the seeds."""
    if group is None or group.mean(column) is None:
        return ""
    deviation = group.deviation(column)
    return number(group.mean(column), 4) + ("" if deviation is None else f" ± {deviation:.4f}")


def table(header, rows, left=2):
    """`left` is the number of columns of words. The other columns are numbers."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * left + "---:|" * (len(header) - left)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def figures(group):
    """Speed, memory and error of a configuration."""
    if group is None or group.mean("flip") is None:
        return ["failed"] + [""] * 6
    return [significant(group.median("kernel_ms")), significant(group.median("train_ms")), significant(group.median("query_ms")),
            significant(group.mebibytes()), with_deviation(group, "flip"), with_deviation(group, "hdr_flip"),
            with_deviation(group, "rel_mse")]


HEADER = ["step, ms", "with paths, ms", "1920x1080 answers, ms", "MiB", "FLIP", "HDR-FLIP", "relative MSE"]


def without_empty_columns(header, rows):
    kept = [i for i in range(len(header)) if any(row[i] for row in rows)]
    return [header[i] for i in kept], [[row[i] for i in kept] for row in rows]


def configurations(results, integrator, steps=128):
    """A row for each scene and each row of the preset."""
    rows = [[title_of(scene), row, *figures(results.get(scene, integrator, row, steps))]
            for scene in results.scenes() for row in results.rows(integrator) if results.get(scene, integrator, row, steps)]
    return table(*without_empty_columns(["scene", "cache", *HEADER], rows))


def over_steps(results, integrator):
    """FLIP at each step count. Sparse updates of the hash grid differ by less than the digits: table 1 has them."""
    steps = results.steps()
    rows = [[title_of(scene), row, *[with_deviation(results.get(scene, integrator, row, n), "flip") for n in steps]]
            for scene in results.scenes() for row in results.rows(integrator)
            if "sparse" not in row and results.get(scene, integrator, row, steps[-1])]
    return table(["scene", "cache", *[f"{n} steps" for n in steps]], rows)


def seconds_and_errors(results):
    """A row for every point, path tracing first."""
    rows = []
    for scene in results.scenes():
        for row in sorted(results.rows("path")) + results.rows("nrc"):
            points = sorted((key[3], group) for key, group in results.groups.items() if (key[0], key[2]) == (scene, row))
            for point, group in points:
                unit = "spp" if row == "path" else "steps"
                rows.append([title_of(scene), f"{row}, {point} {unit}", significant(group.median("seconds")),
                             significant(group.median("kernel_ms")), significant(group.mebibytes()), with_deviation(group, "flip"),
                             with_deviation(group, "rel_mse")])
    return table(["scene", "", "seconds", "step, ms", "MiB", "FLIP", "relative MSE"], rows)
