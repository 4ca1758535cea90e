"""Runs the steps of scripts/packages/Dockerfile in clean systems, where there is neither Docker nor Apptainer."""

import glob
import os
import re
import shutil

import script
from chroot import Chroot
from script import Failed, run, say

FOLDER = os.path.join(script.ROOT, "scripts", "packages")


def joined_lines(path):
    """The lines without comments, continued lines as one, blanks as single ones."""
    with open(path, encoding="utf-8") as file:
        text = file.read().replace("\\\n", " ")
    return [" ".join(line.split()) for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]


def docker_steps(lines):
    """The steps behind each FROM: pairs of an instruction and its text."""
    stages = []
    for line in lines:
        word, _, text = line.partition(" ")
        if word not in ("ARG", "FROM", "COPY", "RUN", "WORKDIR", "ENTRYPOINT"):
            raise Failed(f"Dockerfile: unknown instruction '{word}'")
        if word == "FROM":
            stages.append([])
        elif stages:
            stages[-1].append((word, text))
    return stages


def commands_of_definition(lines):
    """The commands of each %post of the definition for Apptainer."""
    posts, inside = [], False
    for line in lines:
        if re.match(r"%|[A-Z]\w+: ", line):
            inside = line == "%post"
            if inside:
                posts.append([])
        elif inside:
            posts[-1].append(line)
    return posts


def same_steps():
    """The steps of the Dockerfile by stage. Throws where gatelight.def has other commands."""
    stages = docker_steps(joined_lines(os.path.join(FOLDER, "Dockerfile")))
    ran = [[text for word, text in steps if word == "RUN"] for steps in stages]
    if ran != commands_of_definition(joined_lines(os.path.join(FOLDER, "gatelight.def"))):
        raise Failed("gatelight.def has other commands than the Dockerfile")
    return stages


def copy_sources(system, target):
    """The files that git knows, and what is left of a build on this machine, which must not disturb."""
    for name in run(["git", "-C", script.ROOT, "ls-files"]).splitlines():
        system.copy_in(os.path.join(script.ROOT, name), os.path.join(target, name))
    shutil.copytree(os.path.join(script.ROOT, ".git"), system.path(os.path.join(target, ".git")), symlinks=True)
    os.makedirs(system.path(os.path.join(target, "build", "packages")))
    script.write(system.path(os.path.join(target, "build", "packages", "CMakeCache.txt")), "CMAKE_HOME_DIRECTORY:INTERNAL=/elsewhere\n")


def copy_denoiser(system):
    """Open Image Denoise, if this machine has fetched it: the download is not what is tested here."""
    cache = os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "gatelight")
    if os.path.isdir(cache):
        system.copy_in(cache, "/root/.cache/gatelight")


def run_stage(system, former, steps):
    """Runs the steps of a stage. Returns the program that the container starts."""
    entry = None
    for word, text in steps:
        say(f"{word} {text}")
        if word == "RUN":
            system.run(text)
        elif word == "WORKDIR":
            system.run(f"mkdir -p {text}")
        elif word == "ENTRYPOINT":
            entry = re.fullmatch(r'\["([\w-]+)"\]', text)[1]
        elif text.startswith("--from="):
            _, *patterns, target = text.split()
            for pattern in patterns:
                for file in glob.glob(former.path(pattern)):
                    system.copy_in(file, os.path.join(target, os.path.basename(file)))
        else:
            copy_sources(system, text.split()[1])
            copy_denoiser(system)
    return entry


def check(base, work):
    """Returns the exit code."""
    former = None
    for number, steps in enumerate(same_steps()):
        system = base.copy(os.path.join(work, f"stage{number}"))
        entry = run_stage(system, former, steps)
        former = Chroot(system.folder, system.archives)
    former.copy_in(os.path.join(script.ROOT, "data", "cornell-box.glb"), "/work/cornell-box.glb")
    former.run(f"cd /work && {entry} render cornell-box.glb -o picture.png --preset preview --denoiser oidn --quiet")
    former.run(f"cd /work && {entry} render cornell-box.glb -o picture.tif --spp 1 --size 16x16 --quiet")  # by OpenImageIO
    if not os.path.getsize(former.path("/work/picture.png")):
        raise Failed("the container's program wrote no picture")
    print("recipes: the steps of the Dockerfile, which gatelight.def has too, give a program that renders a denoised picture")
    return 0
