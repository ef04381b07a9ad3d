"""Builds from nothing in bare Debians 12 (mmdebstrap from this system's sources). The first: `./do tables 4.5` in a clean clone installs the first
part of packages.txt alone, and what its program lacks it says; then the RUN lines of the Containerfile's first stage, which build the whole
and its package. The second: those of the second stage; the installed package prints table 4.5. Some half an hour and 8 GB of disk.

bare_debian.py SOURCE FOLDER [DEB]   with DEB, the second alone
"""

import pathlib
import re
import shutil
import subprocess
import sys
import time

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


def run(root, command, where="/", check=True):
    """Runs a command as a container's engine does, without one."""
    inside = f'mount -t proc proc "{root}/proc"; mount --rbind /dev "{root}/dev"; exec chroot "{root}" sh -euc "cd {where}; $0"'
    environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "HOME": "/root", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(["unshare", "--mount", "sh", "-euc", inside, command], env=environment, check=check, stdout=subprocess.PIPE, text=True)


def size_of(root):
    """Packages and megabytes, without what apt has downloaded."""
    packages = subprocess.run(["dpkg-query", "--admindir", root / "var/lib/dpkg", "-W"], capture_output=True, text=True, check=True).stdout
    words = ["du", "-smx", "--exclude=*.deb", root]
    return len(packages.splitlines()), int(subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()[0])


def build_first_part(root):
    """What a newcomer types first, and what it costs."""
    n_bare, bare_megabytes = size_of(root)
    begin = time.monotonic()
    said = run(root, "./do tables 4.5", "/springproof").stdout
    minutes = (time.monotonic() - begin) / 60
    n_packages, megabytes = size_of(root)
    downloads = sum(file.stat().st_size for file in (root / "var/cache/apt/archives").glob("*.deb")) / 1e6
    print(f"./do tables 4.5 from nothing: {minutes:.1f} minutes, {n_packages - n_bare} packages, {downloads:.0f} MB downloaded, "
          f"{megabytes - bare_megabytes} MB on disk", flush=True)
    assert "4.5" in said and "-4.9" in said, "table 4.5 has no -4.9 %"
    program, block = "build/springproof", "examples/library/block.toml"
    assert "top" in run(root, f"./do run {block}", "/springproof").stdout
    for words in (f"run {block} --out /tmp/out", "gate cases/gates/sheared_cube.toml --out /tmp/out", "tables 4.5 --out /tmp/out",
                  "run --only msm cases/studies/bean/case.toml", f"export {block} --to vtu --out /tmp/out"):
        refused = run(root, f"{program} {words} 2>&1", "/springproof", check=False)
        assert refused.returncode == 2, f"{words}: status {refused.returncode}: {refused.stdout}"
        assert "no VTK" in refused.stdout and "./do packages" in refused.stdout, f"{words}: {refused.stdout}"
    assert not (root / "tmp/out").exists(), "a refused command has left a folder"


recipe = (source / "Containerfile").read_text()
stages = [re.findall(r"^RUN (.*)", stage, re.MULTILINE) for stage in re.split(r"^FROM .*", recipe, flags=re.MULTILINE)[1:]]
assert len(stages) == 2 and all(stages)
if package is None:
    build = bare("build")
    subprocess.run(["git", "clone", "-q", source, build / "springproof"], check=True)
    build_first_part(build)
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
