"""Starts gatelight-mpi, on one machine or on two that are network namespaces."""

import os
import pathlib
import shutil
import subprocess
import time

HOSTS = {"gatelight-a": "10.77.0.1", "gatelight-b": "10.77.0.2"}
NETWORK = "10.77.0.0/24"


class Skipped(Exception):
    """Something that a test needs is missing."""


def launcher():
    """The command of Open MPI or MPICH that starts ranks on this machine, without their number."""
    name = os.environ.get("GATELIGHT_MPIRUN") or shutil.which("mpirun")
    if not name or not shutil.which(name):
        raise Skipped("no mpirun")
    said = subprocess.run([name, "--version"], capture_output=True, text=True).stdout
    if "Open MPI" in said:
        return [name, "--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]
    return [name]


class Program:
    def __init__(self, folder, scene):
        self.folder = pathlib.Path(folder).resolve()
        self.scene = scene
        self.alone_program = self.folder / "gatelight"
        self.program = self.folder / "gatelight-mpi"
        if not self.program.exists():
            raise Skipped("gatelight-mpi was not built")

    def alone(self, *words):
        return subprocess.run([self.alone_program, *words], capture_output=True, text=True)

    def command(self, ranks, *words):
        return [*launcher(), "-n", str(ranks), str(self.program), *map(str, words)]

    def start(self, ranks, *words, environment=None):
        return subprocess.Popen(
            self.command(ranks, *words), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env={**os.environ, **(environment or {})})

    def run(self, ranks, *words, environment=None):
        process = self.start(ranks, *words, environment=environment)
        output = output_of(process, 300)
        return process.returncode, output

    def processes(self, launched, ranks, seconds=60):
        """The process ids of the ranks, in the order of their start, once all have started."""
        end = time.time() + seconds
        while time.time() < end:
            found = [pid for pid in descendants(launched.pid) if executable(pid) == str(self.program)]
            if len(found) == ranks:
                return sorted(found)
            time.sleep(0.02)
        raise TimeoutError(f"{ranks} ranks did not start")


def output_of(process, seconds):
    """Waits for the end. Open MPI 5 also prints the zero byte behind its own message, before any line of ours."""
    output, _ = process.communicate(timeout=seconds)
    return output.replace("\0", "")


def executable(pid):
    try:
        return os.readlink(f"/proc/{pid}/exe")
    except OSError:
        return ""


def descendants(pid):
    children = {}
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            parent = int(pathlib.Path(f"/proc/{entry}/stat").read_text().rsplit(")", 1)[1].split()[1])
        except (OSError, IndexError):
            continue
        children.setdefault(parent, []).append(int(entry))
    found, left = [], [pid]
    while left:
        for child in children.get(left.pop(), []):
            found.append(child)
            left.append(child)
    return found


class TwoMachines:
    """Two network namespaces and a line between them, for Open MPI."""

    def __init__(self, rate="1gbit", delay="0.25ms"):
        self.rate, self.delay, self.delayed = rate, delay, False

    def limit(self, host):
        """Kernels without netem have no delay."""
        add = ["ip", "netns", "exec", host, "tc", "qdisc", "add", "dev", "gla", "root"]
        netem = [*add, "netem", "delay", self.delay, "rate", self.rate, "limit", "100000"]
        self.delayed = subprocess.run(netem, capture_output=True).returncode == 0
        if not self.delayed:
            rate = [*add, "tbf", "rate", self.rate, "burst", "128kb", "latency", "20ms"]
            subprocess.run(rate, check=True, capture_output=True)

    def ip(self, *words):
        subprocess.run(["ip", *words], check=True, capture_output=True)

    def __enter__(self):
        try:
            self.__exit__()
            a, b = HOSTS
            for host in HOSTS:
                self.ip("netns", "add", host)
            self.ip("link", "add", "gla", "netns", a, "type", "veth", "peer", "name", "gla", "netns", b)
            for host, address in HOSTS.items():
                self.ip("-n", host, "addr", "add", f"{address}/24", "dev", "gla")
                self.ip("-n", host, "link", "set", "gla", "up")
                self.ip("-n", host, "link", "set", "lo", "up")
                self.limit(host)
        except (OSError, subprocess.CalledProcessError) as error:
            self.__exit__()
            raise Skipped(f"no network namespaces here: {error}") from error
        return self

    def __exit__(self, *_):
        for host in HOSTS:
            subprocess.run(["ip", "netns", "del", host], capture_output=True)

    def command(self, program, words, ranks_of_each=1):
        agent = pathlib.Path(__file__).with_name("namespace-agent")
        hosts = ",".join(f"{address}:{ranks_of_each}" for address in HOSTS.values())
        options = ["--mca", "plm_rsh_agent", str(agent), "--mca", "btl", "tcp,self", "--mca", "btl_tcp_if_include",
                   NETWORK, "--mca", "oob_tcp_if_include", NETWORK, "--host", hosts]
        first = next(iter(HOSTS))
        return ["ip", "netns", "exec", first, *launcher(), *options, "-n", str(2 * ranks_of_each),
                str(program.program), *map(str, words)]
