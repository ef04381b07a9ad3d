"""What a person at a terminal gets besides: colours of verdicts, and the nearest command or option to what was typed.

terminal_test.py PROGRAM SOURCE
"""

import os
import pty
import subprocess
import sys

PROGRAM, SOURCE = sys.argv[1:3]
GATE = ["gate", f"{SOURCE}/cases/gates/small_strain_exact.toml"]


def on_a_terminal(words, **environment):
    """Standard output on a terminal."""
    ours, theirs = pty.openpty()
    environment = {"PATH": os.environ["PATH"], "TERM": "xterm", "OPENBLAS_NUM_THREADS": "1", **environment}
    process = subprocess.Popen([PROGRAM, *words], stdout=theirs, stderr=subprocess.PIPE, env=environment)
    os.close(theirs)
    said = b""
    while True:
        try:
            block = os.read(ours, 4096)
        except OSError:  # Linux' end of a pseudo-terminal
            break
        said += block
    _, error = process.communicate(timeout=200)
    os.close(ours)
    return process.returncode, said.decode().replace("\r\n", "\n"), error.decode()


piped = subprocess.run([PROGRAM, *GATE], capture_output=True, text=True, check=True).stdout
status, coloured, error = on_a_terminal(GATE)
assert status == 0 and "\033[32mmet\033[0m" in coloured and "\033[32mall gates met\033[0m" in coloured, (coloured, error)
assert coloured.replace("\033[32m", "").replace("\033[0m", "") == piped, coloured  # colours and nothing else
assert on_a_terminal(GATE, NO_COLOR="1")[1] == piped == on_a_terminal(GATE, TERM="dumb")[1]
assert "\033" not in piped
cube = f"{SOURCE}/cases/thesis/linear_elastic/cube_shear_small.toml"
status, coloured, _ = on_a_terminal(["run", "--set", "measure[0].toward='y'", cube])
assert "\033[31mMISSED\033[0m" in coloured, coloured
assert "\033" not in on_a_terminal(["run", "--only", "msm", "--json", cube])[1]


def refused(words):
    run = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
    assert run.returncode == 2 and not run.stdout, (words, run)
    return run.stderr


assert 'there is no command "tabels"; did you mean "tables"?' in refused(["tabels"])
assert 'there is no command "interpretation"\n' in refused(["interpretation"])  # nothing is near
assert 'run has no option "--convrge"; did you mean "--converge"?' in refused(["run", "--convrge", cube])
assert 'run has no option "--jsno"; did you mean "--json"?' in refused(["run", cube, "--jsno=1"])
assert "worker" not in refused(["workr"])  # a hidden command
print("colours on terminals alone; the nearest command and option are proposed")
