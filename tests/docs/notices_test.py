"""The licences of others in NOTICE.md are those of all packages that the project is built from.

notices_test.py SOURCE
"""

import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
notice = (source / "NOTICE.md").read_text()
faults = []

licence = (source / "LICENSE").read_text()
if "GNU GENERAL PUBLIC LICENSE" not in licence or "Version 3, 29 June 2007" not in licence:
    faults.append("LICENSE is not the GNU General Public License, version 3")

packages = re.sub(r"#.*", "", (source / "packages.txt").read_text()).split()
named = set(re.findall(r"`([^`]+)`", notice))
faults += [f"packages.txt has {package}, NOTICE.md has not" for package in packages if package not in named]

# Where this system has the package, its own word on the licence.
words = {"MIT": "Expat|MIT", "GPL-2.0": "GPL-2", "LGPL-2.1": "LGPL-2.1", "BSD-3-Clause": "BSD", "MPL-2.0": "MPL-2", "Apache-2.0": "Apache-2"}
n_compared = 0
for package, claimed in re.findall(r"^\| `([^`]+)`[^|]*\| ([^|]*) \|", notice, re.MULTILINE):
    copyright = pathlib.Path("/usr/share/doc") / package / "copyright"
    first = next((word for word in words if claimed.startswith(word)), None)
    if first is None or not copyright.exists():
        continue
    n_compared += 1
    if not re.search(words[first], copyright.read_text(errors="replace"), re.IGNORECASE):
        faults.append(f"NOTICE.md has {package} under {first}, which {copyright} does not name")
if n_compared < 8:
    faults.append(f"only {n_compared} licences could be compared with the packages' own")

print("\n".join(faults) or f"{len(packages)} packages are named, {n_compared} licences are those of the packages")
sys.exit(1 if faults else 0)
