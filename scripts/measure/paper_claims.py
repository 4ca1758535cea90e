"""Compares the paper's claims with our measurements: the first table of RESULTS.md. Verdicts follow from the figures."""

from paper_figures import ADAPTIVE_MB, TABLE1, TABLE2
from measured_scenes import title_of
from results_data import difference
from results_tables import table

# Times and sizes with a smaller ratio count as the same.
SAME = 1.1
APPLICATIONS = (("nao", "occlusion"), ("nrc", "radiance"))


def span(values, digits=2):
    values = [value for value in values if value is not None]
    low, high = min(values), max(values)
    return f"{low:.{digits}g}" if f"{low:.{digits}g}" == f"{high:.{digits}g}" else f"{low:.{digits}g} to {high:.{digits}g}"


def pairs(result, integrator, a, b, steps=128):
    """(scene, group of row a, group of row b) where both were measured."""
    for scene in result.scenes():
        groups = [result.get(scene, integrator, row, steps) for row in (a, b)]
        if all(group is not None and group.mean("flip") is not None for group in groups):
            yield title_of(scene), *groups


def verdict(good, total):
    if total == 0:
        return "not measured"
    return "holds" if good == total else "does not hold" if good == 0 else f"holds in {good} of {total}"


def lower_flip(result, integrator, a, b, lower=True):
    """FLIP of both rows in words, and the verdict of: row a has the lower FLIP, or has not where `lower` is False."""
    found = list(pairs(result, integrator, a, b))
    text = "; ".join(f"{name} {x.mean('flip'):.3f} and {y.mean('flip'):.3f}" for name, x, y in found)
    return text, verdict(sum((difference(x, y, "flip") == -1) == lower for _, x, y in found), len(found))


def paper_lower_flip(integrator):
    return "; ".join(f"{scene} {row['gate'][3]:.3f} and {row['hash grid'][3]:.3f}"
                     for (kind, scene), row in TABLE1.items() if kind == integrator)


def times(result, integrator, column, a="hash grid", b="gate"):
    """Ours and verdict of: row a takes longer than row b."""
    found = list(pairs(result, integrator, a, b))
    ratios = [x.median(column) / y.median(column) for _, x, y in found]
    if not ratios:
        return "", "not measured"
    text = "; ".join(f"{name} {ratio:.2g}" for (name, _, _), ratio in zip(found, ratios))
    return text, verdict(sum(ratio > SAME for ratio in ratios), len(ratios))


def paper_times(integrator, index):
    return span([row["hash grid"][index] / row["gate"][index] for (kind, _), row in TABLE1.items() if kind == integrator])


def table1_claims(result):
    for integrator, word in APPLICATIONS:
        yield (f"At equal memory GATE's FLIP is lower than the hash grid's ({word})", paper_lower_flip(integrator),
               *lower_flip(result, integrator, "gate", "hash grid"))
    for integrator, word in APPLICATIONS:
        for column, index, what in (("kernel_ms", 0, "A training step takes the hash grid longer"),
                                    ("query_ms", 1, "Answers take the hash grid longer")):
            yield f"{what} ({word}): times GATE's", paper_times(integrator, index), *times(result, integrator, column)
    for integrator, word in APPLICATIONS:
        yield (f"The hash grid is slow because every step visits every entry ({word}): step, times one with sparse updates",
               "not measured", *times(result, integrator, "kernel_ms", "hash grid", "hash grid, sparse updates"))


def table2_claims(result):
    for integrator, word in APPLICATIONS:
        paper = TABLE2[integrator]
        yield (f"GATE's FLIP is lower than that of a hash grid below 1 MB ({word})",
               f"Bistro {paper['gate'][3]:.3f} and {paper['hash grid S'][3]:.3f}",
               *lower_flip(result, integrator, "gate", "hash grid S"))
        for column, index, what in (("kernel_ms", 0, "A step of a hash grid below 1 MB takes longer"),
                                    ("query_ms", 1, "Answers of a hash grid below 1 MB take longer")):
            yield (f"{what} ({word}): times GATE's", f"{paper['hash grid S'][index] / paper['gate'][index]:.2g}",
                   *times(result, integrator, column, "hash grid S", "gate"))
        yield (f"A larger hash grid errs less ({word}): FLIP of L and S",
               f"Bistro {paper['hash grid L'][3]:.3f} and {paper['hash grid S'][3]:.3f}",
               *lower_flip(result, integrator, "hash grid L", "hash grid S"))


def gain(result, scene, integrator, row, first, last):
    groups = [result.get(scene, integrator, row, steps) for steps in (first, last)]
    values = [group.mean("flip") if group else None for group in groups]
    return None if None in values else 1.0 - values[1] / values[0]


def steps_claims(result):
    steps = result.steps()
    for integrator, word in APPLICATIONS:
        found = []
        for scene in result.scenes():
            gains = [gain(result, scene, integrator, row, steps[0], steps[-1]) for row in ("gate", "hash grid")]
            if None not in gains:
                found.append((title_of(scene), gains))
        yield (f"From {steps[0]} to {steps[-1]} steps GATE keeps improving and the hash grid gains little ({word}): "
               "FLIP falls by, GATE and hash grid", "shown for Bistro, without figures",
               "; ".join(f"{name} {100 * a:.0f} % and {100 * b:.0f} %" for name, (a, b) in found),
               verdict(sum(a > b for _, (a, b) in found), len(found)))


def adaptive_claims(result):
    for integrator, word in APPLICATIONS:
        found = list(pairs(result, integrator, "fixed R = 4", "adaptive, paper's rule"))
        ratios = [x.mebibytes() / y.mebibytes() for _, x, y in found]
        yield (f"Resolution 4 everywhere takes more memory than adaptive resolutions ({word}): times",
               f"Country Kitchen {ADAPTIVE_MB[0] / ADAPTIVE_MB[1]:.2f}",
               "; ".join(f"{name} {ratio:.2g}" for (name, _, _), ratio in zip(found, ratios)),
               verdict(sum(ratio > SAME for ratio in ratios), len(ratios)))
        yield (f"... at similar quality ({word}): FLIP of 4 everywhere and adaptive", "no visible difference",
               *lower_flip(result, integrator, "fixed R = 4", "adaptive, paper's rule", lower=False))
        yield (f"Our rule of uniform density errs less than the paper's ({word})", "not of the paper",
               *lower_flip(result, integrator, "adaptive, uniform", "adaptive, paper's rule"))


def inputs_claims(result):
    for integrator, row in (("nao", "gate, normal"), ("nrc", "gate, normal and albedo")):
        word = "occlusion: normal" if integrator == "nao" else "radiance: normal and albedo"
        yield (f"GATE gains nothing from more inputs ({word}): FLIP with and without", "the same in the end",
               *lower_flip(result, integrator, row, "gate", lower=False))
        yield (f"More inputs slow a step down ({word}): times", "not printed",
               *times(result, integrator, "kernel_ms", row, "gate"))


def extra_claims(result):
    base = "as in the paper"
    for integrator, word in APPLICATIONS:
        for better, worse, claim in ((base, "stack of 1", "Two stacked resolutions err less than one"),
                                     (base, "no candidates", "Choosing among 16 candidates errs less than taking the first"),
                                     (base, "storage per triangle", "Shared storage errs less than vectors of each triangle's own"),
                                     (base, "counters per node", "Step counters of triangles err less than those of nodes"),
                                     ("4 samples per point", base, "The mean of four paths a record errs less than one path")):
            yield f"{claim} ({word})", "stated or implied, no figure", *lower_flip(result, integrator, better, worse)
        yield (f"Features in fp16 lose nothing visible ({word}): FLIP with fp32 and fp16", "an outlook",
               *lower_flip(result, integrator, base, "fp16 features", lower=False))
        yield (f"Clusters on tiny triangles err less ({word}): FLIP with and without, uniform density", "an outlook",
               *lower_flip(result, integrator, "clusters", "uniform, no clusters"))


CLAIMS = {
    "paper-table1": table1_claims,
    "paper-table2": table2_claims,
    "paper-steps": steps_claims,
    "paper-adaptive": adaptive_claims,
    "paper-inputs": inputs_claims,
    "paper-extra": extra_claims,
}


def section(results):
    rows = []
    for preset, claims in CLAIMS.items():
        if preset in results:
            rows += [[claim, paper, ours, f"**{held}**"] for claim, paper, ours, held in claims(results[preset]) if ours]
    return ("## Claim by claim\n\nLower is lower by more than two standard errors of the difference, longer is longer by more than a tenth.\n\n" +
            table(["claim", "paper", "here", "verdict"], rows, left=4))
