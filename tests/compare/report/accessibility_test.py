"""The pages under axe-core, light and dark, wide and narrow: no serious or critical finding.

usage: accessibility_test.py FOLDER PAGE...

axe-core comes from the npm registry, in the version and with the digest of axe/package-lock.json, into FOLDER. Without the registry
nothing is checked, which the test says; where continuous integration runs (CI is set) it fails then.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from chromium import DARK, examine, find_chromium

HERE = Path(__file__).resolve().parent


def install_axe(folder):
    """axe.min.js, or why there is none."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / "axe" / name, folder / name)
    if not shutil.which("npm"):
        return None, "npm is not installed"
    done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline"], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode != 0:
        return None, "npm could not install axe-core:\n" + done.stderr[-2000:]
    return folder / "node_modules" / "axe-core" / "axe.min.js", None


def check(page, axe):
    for name, options in (("light", ("--window-size=1400,1000",)), ("dark", ("--window-size=400,900", DARK))):
        copy, found = examine(page, f"accessibility_{name}.html", axe, HERE / "check_accessibility.js", options=options)
        copy.unlink()
        assert found["passed"] > 20, (page.name, name, "axe has looked at nothing")
        serious = [one for one in found["violations"] if one["impact"] in ("serious", "critical")]
        for one in found["violations"]:
            print(f"{page.name}, {name}: {one['impact']}: {one['id']}: {one['help']}\n  {one['why']}\n  " + "\n  ".join(one["elements"]))
        assert not serious, (page.name, name, [one["id"] for one in serious])


def main():
    if not find_chromium():
        print("no Chromium here: nothing was checked")
        return
    axe, reason = install_axe(Path(sys.argv[1]).resolve())
    if not axe:
        assert not os.environ.get("CI"), reason
        print(f"{reason}\nnothing was checked")
        return
    for page in sys.argv[2:]:
        check(Path(page).resolve(), axe)
    print(f"{len(sys.argv) - 2} pages have no serious finding")


if __name__ == "__main__":
    main()
