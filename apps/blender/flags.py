"""Flags of the program from the values of the panel and of the scene."""

import shlex

# Properties of the panel that are flags; these values leave the choice to the preset.
NAMES = ("preset", "integrator", "denoiser", "glass_shadows", "spp", "time_limit", "max_error", "max_depth", "max_transmission_depth",
         "clamp", "threads", "seed", "device")
NOT_GIVEN = ("", 0, "NONE", "DEFAULT")


class BadFlags(Exception):
    """The text of further flags cannot be taken; the message is for the user."""


def of_panel(values):
    """Flags of the panel's values, by the names of its properties."""
    given = {name: values[name] for name in NAMES if values.get(name, 0) not in NOT_GIVEN}
    words = [word for name, value in given.items()
             for word in ("--" + name.replace("_", "-"), f"{value:g}" if isinstance(value, float) else str(value))]
    return words + further(values.get("more", ""))


def for_media(chosen):
    """The same for a scene whose media have clear surfaces and that has no other glass: light then goes straight, and is sampled at
    each event. The presets have this."""
    return chosen if {"--glass-shadows", "--preset"}.intersection(chosen) else [*chosen, "--glass-shadows", "straight"]


def further(text):
    """The words of the field for all other flags. Throws BadFlags."""
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise BadFlags(f"further flags '{text}': {error}; expected words as on a command line") from error
    for taken in ("-o", "--output", "--size", "--region", "--frames", "--progress"):
        if any(word == taken or word.startswith(taken + "=") for word in words):
            raise BadFlags(f"further flags: {taken} is Blender's own; expected other flags of 'gatelight render'")
    return words


def known_of(words, known):
    """The words without flags that are not among the known ones, and their values."""
    kept, keeps = [], True
    for word in words:
        if word.startswith("--"):
            keeps = word[2:].partition("=")[0] in known
        if keeps:
            kept.append(word)
    return kept


def from_cycles(cycles):
    """Values of the panel for those of Cycles that mean the same. `cycles` has its names. Our depths count events, of which the
    first is no bounce."""
    return {"preset": "NONE", "integrator": "path", "spp": cycles["samples"], "time_limit": cycles["time_limit"],
            "denoiser": "oidn" if cycles["use_denoising"] else "none", "max_depth": cycles["max_bounces"] + 1,
            "max_transmission_depth": cycles["transmission_bounces"] + 1, "seed": cycles["seed"]}
