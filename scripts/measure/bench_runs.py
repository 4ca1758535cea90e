"""Runs of the benchmark programs and of the same in PyTorch, and the cores that other programs use meanwhile."""

import json
import os
import resource
import tempfile
import time

from script import run

TO_SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
# Times are in doubt if other programs use more than this many cores.
DISTURBING = 0.05


def gatelight_rows(program, pattern, *flags, repetitions=1, environment=None):
    """The rows of the benchmarks. For several repetitions they are median, spread and other aggregates."""
    if repetitions > 1:
        flags = (*flags, f"--benchmark_repetitions={repetitions}", "--benchmark_report_aggregates_only=true")
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        run([program, f"--benchmark_filter={pattern}", f"--benchmark_out={out.name}", "--benchmark_out_format=json", *flags], environment)
        text = out.read()
    return json.loads(text)["benchmarks"] if text.strip() else []


def medians(rows):
    return {row["run_name"]: row for row in rows if row.get("aggregate_name", "median") == "median"}


def seconds_of(row):
    return row["real_time"] * TO_SECONDS[row["time_unit"]]


def pytorch_rows(python, environment=None, **flags):
    """The milliseconds that pytorch_cache.py prints, by its names."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pytorch_cache.py")
    words = [word for name, value in flags.items() for word in (f"--{name}", str(value))]
    return json.loads(run([python, program, *words], environment).splitlines()[-1])


class OtherPrograms:
    """Measures the cores that other programs use from now on."""

    def __init__(self):
        self.begin, self.busy = time.monotonic(), self.busy_seconds()

    def cores(self):
        """None where there is no /proc/stat."""
        if self.busy is None:
            return None
        return max(0.0, (self.busy_seconds() - self.busy) / (time.monotonic() - self.begin))

    @staticmethod
    def busy_seconds():
        """Busy seconds of all cores together, without those of our finished children."""
        try:
            with open("/proc/stat", encoding="utf-8") as file:
                user, nice, system, _idle, _wait, irq, soft, steal = map(int, file.readline().split()[1:9])
        except (OSError, ValueError):
            return None
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return (user + nice + system + irq + soft + steal) / os.sysconf("SC_CLK_TCK") - children.ru_utime - children.ru_stime
