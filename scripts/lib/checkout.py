"""A clean Debian with a copy of the committed files in /gatelight, to build and test there."""

import filecmp
import os
import shlex
import shutil
import subprocess

import chroot
import script
from script import ROOT, Failed

CERTIFICATES = "/etc/ssl/certs/ca-certificates.crt"
COPY = "/etc/ssl/of-the-host.crt"  # the system's own ones are written by its package


class System:
    """A Debian in a folder, by its code name. `ccache`: a folder for compiled objects, or None. `required`: what tests must not
    skip (GATELIGHT_REQUIRE_...)."""

    def __init__(self, name, folder, ccache, required=()):
        self.name, self.root = name, os.path.join(os.path.abspath(folder), name)
        self.archives = os.path.join(os.path.dirname(self.root), "archives-" + name)
        binds = {"/dev": "/dev"}
        self.variables = {f"GATELIGHT_REQUIRE_{what}": "1" for what in required}
        for variable in ("GATELIGHT_SCENES", "GATELIGHT_FLIP_PAIR"):
            if variable in os.environ:
                self.variables[variable] = "/" + variable.lower()
                binds[self.variables[variable]] = os.path.abspath(os.environ[variable])
        # How this machine reaches the network.
        self.variables.update({key: value for key, value in os.environ.items() if key.startswith(("PIP_", "http_proxy", "https_proxy"))})
        if os.path.exists(CERTIFICATES):
            self.variables["PIP_CERT"] = COPY
        if ccache:
            binds["/ccache"] = os.path.abspath(ccache)
            self.variables.update(CCACHE_DIR="/ccache", CCACHE_BASEDIR="/gatelight", CCACHE_NOHASHDIR="1",
                                  CCACHE_SLOPPINESS="pch_defines,time_macros,include_file_mtime,include_file_ctime")
        self.launcher = "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache" if ccache else ""
        self.chroot = chroot.Chroot(self.root, self.archives, binds)

    def path(self, inside):
        return self.chroot.path(inside)

    def make(self, clean):
        if clean:
            shutil.rmtree(self.root, ignore_errors=True)
        if os.path.exists(self.path("/etc/debian_version")):
            return
        base = chroot.make_base(self.root, self.name, None, self.archives)
        if os.path.exists(CERTIFICATES):
            base.copy_in(CERTIFICATES, COPY)

    def call(self, command, log=None, check=True):
        """Runs a shell command in the copy of the source. Returns its output."""
        variables = " ".join(f"{key}={shlex.quote(value)}" for key, value in self.variables.items())
        done = subprocess.run(self.chroot.words(f"cd /gatelight; export {variables}; {command}"), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
        if log:
            script.write(log, done.stdout)
        if check and done.returncode != 0:
            raise Failed(f"{self.name}: '{command}' ended with {done.returncode}:\n" + "\n".join(done.stdout.splitlines()[-30:]))
        return done.stdout

    def copy_source(self):
        """The committed files, over those of an earlier run: what has not changed is not built again."""
        source = self.path("/gatelight")
        os.makedirs(source, exist_ok=True)
        fresh = source + ".new"
        shutil.rmtree(fresh, ignore_errors=True)
        os.makedirs(fresh)
        archive = subprocess.run(["git", "-C", ROOT, "archive", "HEAD"], stdout=subprocess.PIPE, check=True).stdout
        subprocess.run(["tar", "-x", "-C", fresh], input=archive, check=True)
        replace_changed(fresh, source)
        shutil.rmtree(fresh)


def files_below(folder):
    """Their paths from the folder, without those of its builds."""
    for place, folders, files in os.walk(folder):
        if place == folder and "build" in folders:
            folders.remove("build")
        yield from (os.path.relpath(os.path.join(place, file), folder) for file in files)


def replace_changed(source, target):
    """Makes the files of a folder equal to those of another one, and keeps the times of those that are."""
    wanted = set(files_below(source))
    for file in set(files_below(target)) - wanted:
        os.remove(os.path.join(target, file))
    for file in wanted:
        a, b = os.path.join(source, file), os.path.join(target, file)
        if not os.path.exists(b) or not filecmp.cmp(a, b, shallow=False):
            os.makedirs(os.path.dirname(b), exist_ok=True)
            shutil.copy(a, b)
