"""`springproof interact --method`: a page in headless Chromium whose body the methods of [msm] real_time step.

usage: methods_test.py SPRINGPROOF CASE FOLDER

Screenshots stay in FOLDER.
"""

import subprocess
import sys
from pathlib import Path

from devtools import Browser, find_chromium
from interact_test import Program


def panel_of(page):
    """The numbers on the page by their names."""
    page.value("show_numbers(), true")
    return page.value("Object.fromEntries([...document.querySelectorAll('dt')].map((term) => [term.textContent, term.nextElementSibling.textContent]))")


def check_methods(springproof, case, folder):
    """Every method is pulled on the page, which shows it, what its step leaves and whether it keeps 60 Hz; the summary says the same."""
    seen = {}
    with Browser() as browser:
        for argument, text in (("xpbd:5:2", "xpbd, 5 iterations, 2 substeps"), ("projective_dynamics", "projective_dynamics, 10 iterations, 1 substep"),
                               ("vertex_block_descent:1", "vertex_block_descent, 1 iteration, 1 substep"), ("implicit_euler:2", "implicit_euler, 2 iterations, 1 substep"),
                               ("symplectic_euler", "symplectic_euler, ")):
            program = Program(springproof, case, "--method", argument, "--stay")
            page = browser.open(program.address)
            page.wait_until("typeof seen !== 'undefined' && seen.frames > 5")
            x, y = page.value("(() => { const at = new THREE.Vector3(20, 0, 45).project(view.camera), box = canvas.getBoundingClientRect();"
                              "return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height]; })()")
            page.mouse("mousePressed", x, y)
            for step in range(1, 11):
                page.mouse("mouseMoved", x + 14 * step, y - 6 * step)
            page.wait_until("frame.held >= 0 && frame.force > 0 && frame.residual > 0 && Math.max(...surface.positions.map((at, i) => Math.abs(at - surface.rest[i]))) > 3")
            page.wait_until("document.querySelectorAll('dt').length === 13")
            panel = panel_of(page)
            assert page.value("document.getElementById('method').textContent").startswith(text), panel
            assert panel["60 Hz"] in ("kept", "not kept") and float(panel["residual of the step"].removesuffix(" %")) > 0, panel
            page.screenshot(folder / f"{argument.replace(':', '_')}.png")
            page.close()
            summary = program.interrupt()
            assert summary["method"].startswith(text) and summary["failed_steps"] == 0 and summary["largest_residual"] > 0, summary
            assert summary["keeps_60_hz"] == (summary["step_ms"]["p99"] <= 1000 / 60), summary
            seen[argument] = (panel["residual of the step"], panel["60 Hz"])
    return seen


def check_refused_methods(springproof, case):
    for argument, reason in (("xpdb", "names no method"), ("xpbd:0", '"0" iterations, may have 1 to 100000'), ("xpbd:5:x", '"x" substeps'), ("xpbd:1:1:1", "more than two")):
        done = subprocess.run([springproof, "interact", case, "--method", argument], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and reason in done.stderr and "NAME:ITERATIONS:SUBSTEPS" in done.stderr, done


def main():
    springproof, case, folder = sys.argv[1], *map(Path, sys.argv[2:4])
    folder.mkdir(parents=True, exist_ok=True)
    check_refused_methods(springproof, case)
    if not find_chromium():
        print("no Chromium here: the page itself was not opened, the test is skipped")
        return
    print(f"residual and 60 Hz: {check_methods(springproof, case, folder.resolve())}")


if __name__ == "__main__":
    main()
