"""Pages in headless Chromium, which may fetch nothing. Only Python's standard library is used."""

import json
import re
import shutil
import subprocess
import tempfile


def find_chromium():
    return shutil.which("chromium") or shutil.which("chromium-browser")


def run_chromium(page, *options):
    """Standard output of a headless browser on a page that it may not leave; console messages are failures."""
    with tempfile.TemporaryDirectory() as profile:
        command = [find_chromium(), "--headless", "--no-sandbox",  # the page is our own, and containers have neither users nor namespaces
                   "--user-data-dir=" + profile, "--no-first-run", "--disable-extensions",
                   "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic",
                   "--host-resolver-rules=MAP * ~NOTFOUND",  # nothing may be fetched
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL without a graphics card
                   "--enable-logging=stderr", "--hide-scrollbars", *options, page.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    messages = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert done.returncode == 0, done.stderr[-2000:]
    assert not messages, "\n".join(messages)
    return done.stdout


DARK = "--blink-settings=preferredColorScheme=0"


def examine(page, name, *scripts, options=()):
    """What the last of some scripts, appended to a copy of a page, has found: the JSON that it left in an element "found"."""
    text = page.read_text()
    catch = ("<script>window.errors = []; window.addEventListener('error', (e) => errors.push(e.message));"
             "window.addEventListener('unhandledrejection', (e) => errors.push(String(e.reason)));</script>")
    added = "".join(f"<script>{script.read_text()}</script>" for script in scripts)
    assert text.count("<head>") == 1 and text.count("</body>") == 1
    copy = page.parent / name
    copy.write_text(text.replace("<head>", "<head>" + catch).replace("</body>", added + "</body>"))
    dom = run_chromium(copy, *options, "--dump-dom", "--virtual-time-budget=60000")
    match = re.search(r'<script type="application/json" id="found">(.*?)</script>', dom, re.S)
    assert match, "the page's own scripts did not come to their end"
    found = json.loads(match.group(1))
    assert found["errors"] == [], found["errors"]
    return copy, found
