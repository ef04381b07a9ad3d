"""The RUN lines of the Containerfile, each stage in a bare Debian 12 of its own (mmdebstrap from this system's sources): the package is
built from a clean clone in the first, installed in the second, and prints table 4.5 there. Some twenty minutes and 8 GB of disk.

bare_debian.py SOURCE FOLDER [DEB]   with DEB, the second stage alone
"""

import pathlib
import re
import shutil
import subprocess
import sys

source, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
package = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None

if not shutil.which("mmdebstrap"):
    print("mmdebstrap is not installed: nothing was compared")
    sys.exit(0)


def bare(name):
    """A Debian with the essential packages and apt alone."""
    root = folder / name
    shutil.rmtree(root, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["mmdebstrap", "--variant=apt", "bookworm", root, "/etc/apt/sources.list.d/debian.sources"], check=True)
    return root


def run(root, command, where="/"):
    """As a container's engine does, without one."""
    inside = f'mount -t proc proc "{root}/proc"; mount --rbind /dev "{root}/dev"; exec chroot "{root}" sh -euc "cd {where}; $0"'
    environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(["unshare", "--mount", "sh", "-euc", inside, command], env=environment, check=True, stdout=subprocess.PIPE, text=True)


recipe = (source / "Containerfile").read_text()
stages = [re.findall(r"^RUN (.*)", stage, re.MULTILINE) for stage in re.split(r"^FROM .*", recipe, flags=re.MULTILINE)[1:]]
assert len(stages) == 2 and all(stages)
if package is None:
    build = bare("build")
    subprocess.run(["git", "clone", "-q", source, build / "springproof"], check=True)
    for command in stages[0]:
        run(build, command, "/springproof")
    package = next((build / "springproof/build").glob("springproof_*.deb"))
install = bare("install")
shutil.copy(package, install / "tmp")
for command in stages[1]:
    run(install, command)
said = run(install, "springproof tables 4.5").stdout
print(said)
assert "4.5" in said and "-4.9" in said, "table 4.5 has no -4.9 %"
shutil.rmtree(folder)
