"""Debian systems in folders, to try packages in: made by debootstrap, entered by chroot in namespaces of their own.

A command's mounts are in its own mount namespace and its processes in its own process namespace, so nothing stays mounted
or running when it ends, however it ends."""

import os
import shutil
import signal
import subprocess
import threading

from script import Failed, run

# Files of the system itself: lists, logs, caches.
STATE = ("proc", "dev", "sys", "tmp", "run", "var/lib/dpkg", "var/lib/apt", "var/cache", "var/log", "etc/ld.so.cache")
# The root is made a mount point: programs may change how mounts propagate only there.
ENTER = """
set -e
mount --bind "$1" "$1"
mount -t proc proc "$1/proc"
mount --bind "$2" "$1/var/cache/apt/archives"
for pair in "${@:4}"; do
  mount --rbind "${pair%%:*}" "$1${pair#*:}"
done
exec chroot "$1" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
  LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash -c "cd /root; $3"
"""
NEEDED = ("debootstrap", "unshare", "chroot", "mount")


def need_root():
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing:
        raise Failed(f"needs {', '.join(missing)}: install {'debootstrap' if 'debootstrap' in missing else 'util-linux'}")
    if os.geteuid() != 0:
        raise Failed("needs root, for chroot and mount")


def suite():
    """The code name of the Debian that this runs on, such as bookworm."""
    with open("/etc/os-release", encoding="utf-8") as file:
        values = dict(line.rstrip("\n").split("=", 1) for line in file if "=" in line)
    name = values.get("VERSION_CODENAME", "").strip('"')
    if values.get("ID") != "debian" or not name:
        raise Failed("this system is not a Debian with a code name (/etc/os-release)")
    return name


class Chroot:
    """`archives` keeps the packages that apt downloads. `binds`: folders of the host, by their names here."""

    def __init__(self, folder, archives, binds=None):
        self.folder = folder
        self.archives = archives
        self.binds = binds or {}

    def words(self, command):
        for name in self.binds:
            os.makedirs(self.path(name), exist_ok=True)
        return ["unshare", "--mount", "--pid", "--fork", "--kill-child=SIGKILL", "--", "bash", "-c", ENTER, "enter",
                self.folder, self.archives, command, *(f"{source}:{name}" for name, source in self.binds.items())]

    def run(self, command, **more):
        """Runs the text as a shell's command, in /root. Returns its standard output."""
        try:
            return run(self.words(command), **more)
        except Failed as failure:
            lines = str(failure).split(f"{command}' ended with")[-1].splitlines()[-20:]
            raise Failed("\n".join([f"'{command}' failed in the chroot:"] + lines)) from None

    def start(self, command):
        return Background(self.words(command))

    def path(self, name):
        return os.path.join(self.folder, name.lstrip("/"))

    def copy_in(self, source, name):
        target = self.path(name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        if os.path.isdir(source):
            shutil.copytree(source, target, symlinks=True)
        else:
            shutil.copy(source, target)

    def files(self):
        """All paths but those of STATE."""
        found = set()
        left = [""]
        while left:
            folder = left.pop()
            with os.scandir(os.path.join(self.folder, folder)) as entries:
                for entry in entries:
                    name = os.path.join(folder, entry.name)
                    if name in STATE:
                        continue
                    found.add(name)
                    if entry.is_dir(follow_symlinks=False):
                        left.append(name)
        return found

    def copy(self, folder):
        run(["cp", "--archive", "--reflink=auto", self.folder, folder])
        return Chroot(folder, self.archives)


class Background:
    """A command that runs until stop(). Its output is read all the time."""

    def __init__(self, words):
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.lines = []
        self.more = threading.Condition()
        self.ended = False
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            with self.more:
                self.lines.append(line)
                self.more.notify_all()
        with self.more:
            self.ended = True
            self.more.notify_all()

    def wait_for(self, word, seconds):
        """The first line with this word."""
        def matching():
            return [line for line in self.lines if word in line]
        with self.more:
            self.more.wait_for(lambda: matching() or self.ended, seconds)
            if not matching():
                raise Failed(f"no line with '{word}' in {seconds} s:\n{''.join(self.lines)}")
            return matching()[0]

    def stop(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self.reader.join()


def make_base(folder, name, mirror, archives):
    """A minimal Debian by its code name, with current lists of packages. `mirror` may be None: debootstrap's own."""
    os.makedirs(os.path.join(archives, "partial"), exist_ok=True)
    run(["debootstrap", "--variant=minbase", f"--cache-dir={archives}", name, folder, *([mirror] if mirror else [])])
    base = Chroot(folder, archives)
    with open(base.path("etc/apt/sources.list"), encoding="utf-8") as file:
        mirror = file.read().split()[1]  # "deb MIRROR SUITE main"
    security = mirror.rstrip("/") + "-security"
    with open(base.path("etc/apt/sources.list"), "w", encoding="utf-8") as file:
        file.write(f"deb {mirror} {name} main\ndeb {mirror} {name}-updates main\ndeb {security} {name}-security main\n")
    # The host's proxy, if it has one. The archives belong to root.
    wanted = ("Acquire::http", "Acquire::https", "Acquire::Check-", "Acquire::ForceIPv")
    lines = [line for line in run(["apt-config", "dump"]).splitlines() if line.startswith(wanted)]
    with open(base.path("etc/apt/apt.conf.d/90check"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines + ['APT::Sandbox::User "root";', 'APT::Keep-Downloaded-Packages "true";', ""]))
    for name in ("/etc/resolv.conf", "/etc/hosts"):
        if os.path.exists(name):
            shutil.copyfile(name, base.path(name))
    base.run("apt-get update")
    return base
