"""Writes data/results/RESULTS.md from the figures in its folder. Only SUMMARY is written by hand: check it after new measurements."""

import os
import re
import textwrap

import paper_claims
import results_tables as tables
from measured_scenes import title_of
from results_data import Results

TITLES = {
    "paper-table1": "Table 1: equal memory, 128 steps",
    "paper-table2": "Table 2: sizes of the hash grid, 128 steps",
    "paper-steps": "Steps: FLIP after 8 to 128",
    "paper-adaptive": "Resolution 4 everywhere against adaptive ones",
    "paper-inputs": "With and without normal and albedo",
    "paper-extra": "What the paper leaves open, one thing changed at a time, 128 steps",
    "defaults": "Not the paper's settings but Gatelight's: GATE, the hash grid with its memory, and path tracing",
}
INTRODUCTION = """# The paper's experiments on a CPU

*GATE: Geometry-Aware Trained Encoding* (Bokšanský, Meister, Benthin, HPG 2025) measures a GPU; here are its experiments on CPU cores, by

```
{command}
```

which writes the figures beside this page (`NAME.csv`: a row for each picture; `NAME.json`: machine, command, references) and the page itself.

- Machine: {cpu}, {threads} threads, {isa}; Gatelight {version}. Pictures of {sizes}, {seeds} seeds: mean ± standard deviation; times are medians.
- The settings are the paper's (`--preset paper-nao`, `paper-nrc` of `gatelight render`): 49152 records a step, two levels with the paper's rule for
  the resolution, two hidden layers of 32, L2, no bias, 16 candidates, paths of four segments; the picture shows the cache at the first hit. They are not
  Gatelight's defaults, which learn far better: `renderer/cache/README.md`.
- The paper states neither learning rate nor initial values of the network, the size of its hash tables, nor which FLIP it means, and its
  resolutions R need a scale per scene that it does not print. Its FLIP can be compared with ours in trend, not in value.
- FLIP is that of tone-mapped pictures at 67 pixels per degree, against references of {reference} samples a pixel, whose noise is in every FLIP; relative MSE has it subtracted.
- Scenes: the Country Kitchen is the paper's; Bistro is a cut of its exterior; Salle de bain, Sponza and the Stadium (a teapot of millimetres in a hall of 200 m) are ours.
"""

SUMMARY = """## Summary

- **GATE's arithmetic is cheap here, too.** At equal memory a training step of the hash grid takes 3.4 to 4.9 times as long as GATE's, its answers
  2.4 to 4.7 times: eight levels of eight corners against two levels of three nodes. The paper's greatest factor, 56, does not occur here:
  it is the cost of visiting 190 MB in every step. A visit of our tables (up to 52 MiB) costs 3 to 23 % of a step, and with sparse updates nothing, for the same FLIP;
  the size of the hash grid hardly matters on a CPU.
- **But the step is not the main cost of training on a CPU.** 80 to 95 % of GATE's training goes into paths. The paper's choice among 16 candidates needs the
  camera's hits of 16 pixels for each record: with paths a step of GATE takes longer than one of the hash grid but for the stadium's occlusion.
  Without candidates it takes 17 instead of 49 ms in the Kitchen (radiance: 82 instead of 130), and errs no more.
- **With the paper's settings GATE loses to the hash grid at equal memory**, clearly in occlusion, by less in radiance (in Sponza and Bistro within the
  noise of three seeds). The hash grid reads the normal, too, which brings GATE's occlusion a part of the way. Most of it is noise: 128 steps are 6.3 million
  records of one path each; a node of a fine mesh meets a few dozen of them, and with a constant learning rate and no average it follows the last ones: right on
  the mean, grainy to look at. The hash grid's coarse levels average over thousands. No reading of what the paper leaves open gave its FLIP of 0.02 to 0.04: one
  candidate, averaged parameters and a lower rate changed little.
- **What closes the gap** is in Gatelight's defaults: resolutions of uniform density, a stack of four levels and clusters (the coarse ones learn first), relative loss with biases,
  a decaying rate, averaged parameters, the normal as an input, and no candidates. With these, at the hash grid's memory, GATE's FLIP is as low or lower from 512 steps on,
  in 75 to 82 % of the time (last table but one).
- **The paper's rule for the resolution** saves memory as stated, but not without loss: it gives nearly all nodes to the largest triangles. Uniform density is better in occlusion, in every
  scene as good as resolution 4 everywhere for a fifth to a half of its memory; in radiance, too noisy after 128 steps to need resolution, they do not differ.
- **Choices that the paper leaves open**, in the Kitchen's occlusion: clusters on tiny triangles gain most (with uniform density, for 5.9 instead of 14.4 MiB); vectors that
  triangles share beat vectors of their own, which take six times the memory; four paths a record gain a little for half as much time again; fp16 features take half the
  memory and lose nothing. In radiance three seeds show no difference; in the picture, a cache of only indirect light errs least (relative MSE).
"""


def word_after(command, flag, otherwise):
    return command[command.index(flag) + 1] if flag in command else otherwise


def introduction(results):
    about = next(iter(results.values())).about
    commands = [result.about["command"] for result in results.values()]
    spp = word_after(about["command"], "--reference-spp", "1024")
    return INTRODUCTION.format(command=f"scripts/measure/measure-paper -o DIR --reference-spp {spp}", reference=spp,
                               sizes=" and ".join(dict.fromkeys(word_after(command, "--size", "1920x1080") for command in commands)),
                               seeds=max(r.seeds() for r in results.values()), version=about["version"], **about["machine"])


def reference_noise(results):
    """A table of the references' noise."""
    noise = {}
    for name, result in results.items():
        if name != "defaults":
            for scene in result.about["scenes"]:
                for reference in scene["references"]:
                    noise[scene["name"], reference["kind"]] = reference
    rows = [[title_of(scene), f"`{kind}`", f"{reference['rel_mse_noise']:.4f}", f"{reference['flip_of_halves']:.3f}"]
            for (scene, kind), reference in noise.items()]
    return ("## Noise of the references\n\nFLIP between the two halves of a reference is the FLIP of noise with twice the reference's deviation.\n\n" +
            tables.table(["scene", "reference", "relative MSE", "FLIP of its halves"], rows))


def section(name, result):
    text = f"## {TITLES[name]}\n"
    if name == "defaults":
        return text + "\n" + tables.seconds_and_errors(result)
    over = result.steps()
    for integrator in ("nao", "nrc"):
        if not result.rows(integrator):
            continue
        text += f"\n{tables.WORDS[integrator]}\n\n"
        if len(over) > 1:
            text += tables.over_steps(result, integrator) + "\n"
        # Table 1 says the rest of paper-steps.
        if name != "paper-steps":
            text += tables.configurations(result, integrator, over[-1])
    return text


def wrap(text):
    """Paragraphs and list items in lines of at most 120 characters; all else as it is."""
    blocks = re.split(r"(\n\n|\n(?=- )|```.*?```)", text, flags=re.DOTALL)
    return "".join(block if block.startswith(("|", "#", "!", "```", "\n")) or max(map(len, block.split("\n"))) <= 120 else
                   textwrap.fill(" ".join(block.split()), 120, subsequent_indent="  " if block.startswith("- ") else "", break_long_words=False,
                                 break_on_hyphens=False) for block in blocks)


def write(folder):
    results = {name: Results(folder, name) for name in TITLES if os.path.exists(os.path.join(folder, name + ".csv"))}
    if not results:
        return
    parts = [introduction(results), SUMMARY, paper_claims.section(results)]
    parts += [section(name, result) for name, result in results.items()]
    parts += [reference_noise(results)]
    with open(os.path.join(folder, "RESULTS.md"), "w", encoding="utf-8") as file:
        file.write(wrap("\n".join(parts)))
