"""Runs a test and notes the processor time that it and its processes took.

processor_time.py FOLDER NAME COMMAND...    runs COMMAND and writes its seconds to FOLDER, one file a test
processor_time.py FOLDER                    is the check of the long tier: it fails when a test of the default tier took more than 20 s
                                            of processor time twice, the second time alone, and names those of more than 5 s

The check is run in the build folder. It reads what the last `./do test` left, and fails when that is nothing.
"""

import json
import pathlib
import re
import resource
import subprocess
import sys

AIM = 5.0
LIMIT = 4 * AIM  # a slow machine takes twice as long as a fast one


def file_of(folder, name):
    return pathlib.Path(folder) / (re.sub(r"\W+", "_", name) + ".json")


def seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run(folder, name, command):
    status = subprocess.run(command).returncode
    file = file_of(folder, name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"test": name, "seconds": seconds_of_children()}))
    return status if status >= 0 else 128 - status


def default_tests():
    listed = subprocess.run(["ctest", "-N", "-L", "^default$"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"Test +#\d+: (.*\S)", listed)


def check(folder):
    names = default_tests()
    records = {name: json.loads(file_of(folder, name).read_text())["seconds"] for name in names if file_of(folder, name).exists()}
    if len(records) < len(names):
        print(f"{len(names) - len(records)} of {len(names)} default tests left no time: run `./do test` before the long tier")
        return 1
    print(f"{len(names)} default tests took {sum(records.values()):.0f} s of processor time")
    failures = 0
    for name in sorted((name for name in names if records[name] > AIM), key=records.get, reverse=True):
        if records[name] <= LIMIT:
            print(f"{name}: {records[name]:.1f} s, more than {AIM:.0f}")
            continue
        subprocess.run(["ctest", "-R", f"^{re.escape(name)}$"], stdout=subprocess.DEVNULL, check=False)
        again = json.loads(file_of(folder, name).read_text())["seconds"]
        print(f"{name}: {records[name]:.1f} s, and {again:.1f} s alone")
        failures += again > LIMIT
    if failures:
        print(f"{failures} tests take more than {LIMIT:.0f} s: make them shorter, or tests of the long tier ([long])")
    return 1 if failures else 0


if __name__ == "__main__":
    folder, *rest = sys.argv[1:]
    sys.exit(run(folder, rest[0], rest[1:]) if rest else check(folder))
