"""Of scripts/check/coverage: what gcov counted, by folder and by file."""

import collections
import concurrent.futures
import gzip
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDERS = {"neural": 0.95, "scene": 0.85, "renderer": 0.85, "apps": 0.85}


def counts_of(path):
    """gcov's JSON of one object file: {source: {line: executions}}."""
    lines = collections.defaultdict(dict)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["gcov", "--json-format", path], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       check=False)
        for name in os.listdir(folder):
            with gzip.open(os.path.join(folder, name), "rt", encoding="utf-8") as file:
                answer = json.load(file)
            for source in answer["files"]:
                full = os.path.normpath(os.path.join(answer["current_working_directory"], source["file"]))
                relative = os.path.relpath(full, ROOT)
                if relative.split(os.sep)[0] not in FOLDERS:
                    continue
                for line in source["lines"]:
                    number = line["line_number"]
                    lines[relative][number] = max(lines[relative].get(number, 0), line["count"])
    return lines


def ranges(numbers):
    """[3, 4, 5, 9] as '3-5, 9'."""
    texts = []
    numbers = sorted(numbers)
    first = 0
    for i, number in enumerate(numbers):
        if i + 1 == len(numbers) or numbers[i + 1] != number + 1:
            texts.append(str(number) if first == i else f"{numbers[first]}-{number}")
            first = i + 1
    return ", ".join(texts)


def main():
    build, jobs = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    notes = []
    for folder, _, names in os.walk(build):
        # Those of the tests count nothing here but inline functions of headers.
        notes += [os.path.join(folder, name) for name in names if name.endswith(".gcno")]
    total = collections.defaultdict(dict)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for lines in pool.map(counts_of, notes):
            for source, counts in lines.items():
                for number, count in counts.items():
                    total[source][number] = total[source].get(number, 0) + count
    if not total:
        print("coverage: nothing was counted", file=sys.stderr)
        sys.exit(2)
    good = True
    print(f"{'folder':10} {'lines':>7} {'executed':>9} {'':>8}  at least")
    for folder, least in FOLDERS.items():
        counts = [count for source, lines in total.items() if source.startswith(folder + os.sep)
                  for count in lines.values()]
        share = sum(count > 0 for count in counts) / max(len(counts), 1)
        good = good and share > least
        print(f"{folder:10} {len(counts):7} {sum(count > 0 for count in counts):9} {share:8.1%}  {least:.0%}"
              f"{'' if share > least else '  TOO FEW'}")
    files = sorted((sum(count > 0 for count in lines.values()) / len(lines), source) for source, lines in total.items())
    with open(os.path.join(build, "coverage.txt"), "w", encoding="utf-8") as report:
        for share, source in files:
            missing = [number for number, count in total[source].items() if count == 0]
            if missing:
                report.write(f"{share:6.1%}  {source}: {ranges(missing)}\n")
    print()
    for share, source in files[:15]:
        missing = sum(count == 0 for count in total[source].values())
        print(f"{share:6.1%}  {source} ({missing} of {len(total[source])} lines not executed)")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
