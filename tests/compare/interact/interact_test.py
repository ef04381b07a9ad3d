"""`springproof interact`: what is refused, what a page may say, and a real page in headless Chromium.

usage: interact_test.py SPRINGPROOF CASE FOLDER [MUTATED]

MUTATED: how many malformed messages are tried (default 1000). A screenshot stays in FOLDER.
"""

import atexit
import csv
import json
import math
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

from devtools import Browser, find_chromium
from web_socket import WebSocket, answer_to, connect, handshake, request_text

POLICY = 1008  # close code of a page that is cut off


class Program:
    def __init__(self, springproof, case, *options, before=None):
        self.process = subprocess.Popen([springproof, "interact", case, "--json", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=before)
        atexit.register(self.process.kill)  # where a check has failed
        line = self.process.stderr.readline()
        assert line.startswith("open http://127.0.0.1:"), line
        self.address = line.split()[1]

    def end(self):
        """The summary, and the exit status."""
        out, err = self.process.communicate(timeout=30)
        assert self.process.returncode == 0, (self.process.returncode, err)
        assert err == "", err
        return json.loads(out)["interaction"]

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return self.end()


class Controller(WebSocket):
    """A page without a browser."""

    def __init__(self, address):
        super().__init__(address)
        assert self.status == 101, self.status
        self.description = json.loads(self.receive()[1])
        opcode, geometry = self.receive()
        assert opcode == 2
        n_vertices, n_triangles, n_nodes, n_spheres = struct.unpack_from("<4I", geometry)
        self.coarse = geometry[16 + 4 * (3 * n_vertices + 16 * n_vertices + 3 * n_triangles + n_spheres):]
        self.n_nodes = n_nodes
        self.rest = struct.unpack_from(f"<{3 * n_vertices}f", geometry, 16)

    def say(self, **message):
        self.send(json.dumps(message))

    def frame(self):
        self.say(type="frame")
        opcode, content = self.receive()
        assert opcode == 2, (opcode, content)
        names = ("time", "steps", "median_ms", "p99_ms", "steps_per_second", "inverted", "held", "force", "failures", "drags", "residual", "nodes")
        numbers = dict(zip(names, struct.unpack_from("<11d", content)))
        assert len(content) == 96 + 12 * self.n_nodes
        numbers["displacement"] = struct.unpack_from(f"<{3 * self.n_nodes}f", content, 96)
        assert all(map(math.isfinite, numbers["displacement"]))
        return numbers


def largest(frame):
    return max(map(abs, frame["displacement"]))


def check_refusals(program):
    """Everything but the page's own requests, in one line and without the page."""
    url = urllib.parse.urlsplit(program.address)
    port, token = url.port, url.query.removeprefix("token=")
    assert len(token) == 32
    own = f"http://127.0.0.1:{port}"
    status, body = answer_to(program.address, request_text(program.address))
    assert status == 200 and "<canvas" in body and token in body
    assert answer_to(program.address, request_text(program.address, Origin=own))[0] == 200
    wrong = token[:-1] + ("0" if token[-1] != "0" else "1")
    refused = {
        "another host (DNS rebinding)": (421, request_text(program.address, host=f"evil.example:{port}")),
        "localhost by its name": (421, request_text(program.address, host=f"localhost:{port}")),
        "the host without its port": (421, request_text(program.address, host="127.0.0.1")),
        "no host": (421, request_text(program.address).replace(f"Host: 127.0.0.1:{port}\r\n", "")),
        "two hosts": (421, request_text(program.address, X="1\r\nHost: evil.example")),
        "another origin": (403, request_text(program.address, Origin="http://evil.example")),
        "another port's origin": (403, request_text(program.address, Origin=f"http://127.0.0.1:{port + 1}")),
        "a file's origin": (403, request_text(program.address, Origin="null")),
        "a wrong token": (403, request_text(program.address, path=f"/?token={wrong}")),
        "half a token": (403, request_text(program.address, path=f"/?token={token[:16]}")),
        "no token": (403, request_text(program.address, path="/")),
        "POST": (405, request_text(program.address, method="POST", Content_Length="0")),
        "another path": (404, request_text(program.address, path=f"/etc/passwd?token={token}")),
        "a path that climbs": (404, request_text(program.address, path=f"/../../etc/passwd?token={token}")),
        "a socket without an origin": (403, handshake(program.address, Origin=None)),
        "a socket of another origin": (403, handshake(program.address, Origin="https://evil.example")),
        "a socket for another host": (421, handshake(program.address, host=f"evil.example:{port}")),
        "a socket with a wrong token": (403, handshake(program.address, path=f"/socket?token={wrong}")),
    }
    for what, (expected, text) in refused.items():
        status, body = answer_to(program.address, text)
        assert status == expected, (what, status, body)
        assert token not in body and body.count("\n") == 1, (what, body)
    for noise in (b"\0" * 1000, os.urandom(5000), b"GET / HTTP/1.1\r\n" + b"X: " + b"y" * 20000 + b"\r\n\r\n", b"GET"):
        assert answer_to(program.address, noise)[0] in (0, 400, 431), noise[:20]
    return len(refused)


def check_pull(program):
    """A ray takes hold, a drag moves the surface towards the pointer, a release lets it go back; a second page waits."""
    page = Controller(program.address)
    assert page.description["masses"] == 5 * 5 * 7
    assert answer_to(program.address, handshake(program.address))[0] == 409, "a second page takes control"
    first = page.frame()
    assert first["held"] == -1
    page.say(type="grab", origin=[200, 20, 50], direction=[-1, 0, 0])
    page.say(type="drag", by=[30, 0, 0])
    end = time.monotonic() + 20
    while (frame := page.frame())["displacement"] and not (frame["held"] >= 0 and largest(frame) > 2):
        assert time.monotonic() < end, frame
    assert frame["force"] > 0 and frame["inverted"] == 0 and frame["failures"] == 0 and 0 < frame["residual"] <= 1e-6
    held = int(frame["held"])
    assert page.rest[3 * held] == 40, "the ray from x+ took hold of another side"
    page.say(type="grab", origin=[200, 20, 500], direction=[0, 0, 1])  # passes beside the body: releases
    while page.frame()["held"] >= 0:
        assert time.monotonic() < end
    moved = largest(page.frame())
    page.say(type="restart")
    while largest(frame := page.frame()) > 0.5 * moved:
        assert time.monotonic() < end
    page.close()


def fine_box(path, n):
    """The surface of the case's block in 12 n² triangles, as STL."""
    size, triangles = (40, 40, 60), []
    for axis in range(3):
        for side in (0, 1):
            def corner(i, j):
                at = [0, 0, 0]
                at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3] = side * size[axis], i * size[(axis + 1) % 3] / n, j * size[(axis + 2) % 3] / n
                return at
            for i in range(n):
                for j in range(n):
                    a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
                    triangles += [(a, b, c), (a, c, d)] if side else [(a, c, b), (a, d, c)]
    path.write_bytes(b" " * 80 + struct.pack("<I", len(triangles)) + b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles))
    return len(triangles)


def check_coarse_bytes(page):
    """The second surface of a large one: at most 5000 triangles, on the same nodes, whose weights make it move with the body."""
    n_vertices, n_triangles, n_nodes, n_spheres = struct.unpack_from("<4I", page.coarse)
    assert 2000 < n_triangles <= 5000 and n_nodes == page.n_nodes and n_spheres == 0, (n_triangles, n_nodes, n_spheres)
    assert len(page.coarse) == 16 + 4 * (19 * n_vertices + 3 * n_triangles)
    at = 16 + 12 * n_vertices
    weights = struct.unpack_from(f"<{8 * n_vertices}f", page.coarse, at)
    nodes = struct.unpack_from(f"<{8 * n_vertices}I", page.coarse, at + 32 * n_vertices)
    triangles = struct.unpack_from(f"<{3 * n_triangles}I", page.coarse, at + 64 * n_vertices)
    assert all(abs(sum(weights[8 * v:8 * v + 8]) - 1) < 1e-5 for v in range(n_vertices))
    assert max(nodes) < n_nodes and max(triangles) < n_vertices


PAINTED = """(() => {
  view.draw(view.drawn);
  const gl = view.renderer.getContext(), width = canvas.width, height = canvas.height, pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let n = 0, n_at_border = 0;
  for (let i = 0; i < width * height; ++i) {
    const x = i % width, y = Math.floor(i / width), is_painted = [0, 1, 2].some((c) => pixels[4 * i + c] !== pixels[c]);
    n += is_painted;
    n_at_border += is_painted && (x === 0 || y === 0 || x === width - 1 || y === height - 1);
  }
  const box = canvas.getBoundingClientRect(), all = stage.getBoundingClientRect();
  return {part: n / (width * height), n_at_border, of_stage: box.width * box.height / (all.width * all.height)};
})()"""


def check_coarse_picture(springproof, case, folder):
    """A page that draws slowly draws the coarse surface of what moves and the fine one of what rests, and no more of the window than the body."""
    n_fine = fine_box(folder / "block.stl", 32)
    text = Path(case).read_text().replace("[[load]]", f"[surface]\nfile = \"{folder}/block.stl\"\n\n[[load]]")
    (folder / "fine.toml").write_text(text)
    program = Program(springproof, folder / "fine.toml", "--stay")
    page = Controller(program.address)
    check_coarse_bytes(page)
    page.close()
    with Browser() as browser:
        page = browser.open(program.address)
        page.wait_until("typeof seen !== 'undefined' && seen.frames > 5")
        assert page.value("[surface, view.coarse].every((each) => each.is_closed())")
        assert page.value("surface.triangles.length") == 3 * n_fine
        page.wait_until("view.is_full")
        n_pictures = page.value("seen.pictures")
        page.wait_until(f"seen.frames > {page.value('seen.frames')} + 20")
        assert page.value("seen.pictures") == n_pictures, "what looks the same is drawn again"
        x, y = page.value("(() => { const at = new THREE.Vector3(20, 0, 45).project(view.camera), box = canvas.getBoundingClientRect();"
                          "return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height]; })()")
        page.value("view.fine_ms = 1000")
        page.mouse("mousePressed", x, y)
        for step in range(1, 11):
            page.mouse("mouseMoved", x + 14 * step, y - 6 * step)
        page.wait_until("frame.held >= 0 && view.drawn === view.coarse && Math.max(...view.coarse.positions.map((at, i) => Math.abs(at - view.coarse.rest[i]))) > 3")
        pulled = page.value(PAINTED)
        assert pulled["part"] > 0.1 and pulled["n_at_border"] == 0 and pulled["of_stage"] < 0.6, pulled
        page.screenshot(folder / "coarse.png")
        page.wait_until("view.is_full && view.drawn === view.fine && view.resolution === 1")  # held, and nothing moves
        page.mouse("mouseReleased", x + 140, y - 60, buttons=0)
        page.value("view.fine_ms = 1000")
        page.wait_until("frame.held < 0 && view.is_full && Math.max(...surface.positions.map((at, i) => Math.abs(at - surface.rest[i]))) < 1")
        problems = [problem for problem in page.problems() if "favicon" not in str(problem)]
        assert problems == [], problems
        page.close()
    program.interrupt()
    return pulled


def mutated(number):
    random.seed(number)
    good = [json.dumps(message) for message in ({"type": "frame"}, {"type": "grab", "origin": [1, 2, 3], "direction": [0, 0, 1]},
                                                {"type": "drag", "by": [1, 2, 3]}, {"type": "release"}, {"type": "restart"})]
    fixed = ["", "null", "[]", "{}", "{\"type\": 1}", "[" * 500, "{\"type\": \"drag\", \"by\": [1e999, 0, 0]}", "{\"type\": \"drag\", \"by\": [NaN, 0, 0]}",
             "{\"type\": \"drag\", \"by\": [1e300, 0, 0]}", "{\"type\": \"drag\", \"by\": [1, 2]}", "{\"type\": \"drag\", \"by\": \"x\"}",
             "{\"type\": \"grab\", \"origin\": [0, 0, 0], \"direction\": [0, 0, 0]}", "{\"type\": \"frame\", \"x\": 1}", "{\"type\": \"%s%n\"}",
             "x" * 513, "x" * 100000, b"\0\1\2", b"{\"type\": \"frame\"}"]
    if number < len(fixed):
        return fixed[number]
    text = list(random.choice(good))
    for _ in range(random.randint(1, 6)):
        at = random.randrange(len(text))
        text[at:at + random.randint(0, 2)] = random.choice(["", "\\", "\"", "{", "}", "[", "9" * 30, "-", "\u0000", "e", ",", "\U0001f600", ":"])
    return "".join(text)


def check_malformed(program, count):
    """Each is refused and cuts the page off, or is a message after all; the simulation goes on and stays finite."""
    n_cut_off, steps = 0, 0
    for number in range(count):
        page = open_when_free(program.address)
        message = mutated(number)
        try:
            page.send(message)
            page.say(type="frame")
            opcode, content = page.receive()
        except ConnectionError:
            opcode, content = 8, struct.pack("!H", POLICY)
        if opcode == 8:
            n_cut_off += 1
            code, = struct.unpack_from("!H", content)
            assert code in (POLICY, 1002, 1007, 1009), (message, code)
        else:
            assert opcode == 2, (message, opcode)
            numbers = struct.unpack_from("<12d", content)
            assert all(map(math.isfinite, numbers)) and numbers[1] > steps, (message, numbers)
            steps = numbers[1]
        page.close()
    page = open_when_free(program.address)
    for _ in range(301):
        page.say(type="release")
    try:
        while page.receive()[0] != 8:
            pass
    except ConnectionError:
        pass
    page.close()
    page = open_when_free(program.address)
    assert page.frame()["steps"] > steps
    page.close()
    return n_cut_off


def check_crowd(program):
    """Connections that say nothing, half of a request or a wrong token keep neither the page nor its socket out, however many they are."""
    crowd = []
    page = open_when_free(program.address)
    for n in range(3 * 32):
        connection = connect(program.address)
        connection.sendall([b"", b"GET /?tok", request_text(program.address, path="/?token=x").encode()[:-2]][n % 3])
        crowd.append(connection)
    status, body = answer_to(program.address, request_text(program.address))
    assert status == 200 and "<canvas" in body, status
    assert page.frame()["held"] == -1, "the page in control was sent away"
    page.close()
    open_when_free(program.address).close()
    for connection in crowd:
        connection.close()


def pull_for_a_while(program):
    """A few steps with a pull, by a page that then stays."""
    page = open_when_free(program.address)
    page.say(type="grab", origin=[200, 20, 50], direction=[-1, 0, 0])
    page.say(type="drag", by=[5, 0, 0])
    end = time.monotonic() + 20
    while page.frame()["force"] <= 0:
        assert time.monotonic() < end
    return page


def check_recordings(springproof, case, folder):
    """No recording is lost: neither to a second one, nor to a session without a pull, nor to a terminal that is closed."""
    out = folder / "recordings"
    shutil.rmtree(out, ignore_errors=True)
    kept = {}
    for ending in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM, None, signal.SIGHUP):
        program = Program(springproof, case, "--stay", "--out", out)
        page = pull_for_a_while(program) if ending else Controller(program.address)
        program.process.send_signal(ending or signal.SIGINT)
        summary = program.end()
        page.close()
        assert (summary["recording"] is None) == (ending is None), summary
        if ending:
            path = Path(summary["recording"])
            assert path not in kept and len(path.read_text().splitlines()) == 1 + summary["pulled_steps"] > 1, (path, summary)
            kept[path] = path.read_bytes()
        assert all(path.read_bytes() == content for path, content in kept.items())
    assert sorted(path.name for path in out.glob("*.csv")) == ["pulled-block_pulls.csv"] + [f"pulled-block_pulls_{n}.csv" for n in (2, 3, 4)]
    # nohup
    program = Program(springproof, case, "--stay", before=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    program.process.send_signal(signal.SIGHUP)
    Controller(program.address).close()
    program.interrupt()


def check_stalled(program):
    """A page that is cut off and goes on as if it were not has no control any more, and holds nothing."""
    page = open_when_free(program.address)
    page.say(type="grab", origin=[200, 20, 50], direction=[-1, 0, 0])
    page.say(type="drag", by=[30, 0, 0])
    assert page.frame()["held"] >= 0
    page.send("no message")  # its connection stays open, its close is not answered
    other = open_when_free(program.address)
    end = time.monotonic() + 20
    while other.frame()["held"] != -1:  # the step that lets go may not have been made yet
        assert time.monotonic() < end
    other.close()
    page.close()


def open_when_free(address):
    """The page before leaves when the server has seen its connection close."""
    for _ in range(200):
        try:
            return Controller(address)
        except AssertionError as error:
            if error.args != (409,):
                raise
            time.sleep(0.02)
    raise AssertionError("nobody is in control, and nobody can be")


def check_browser(springproof, case, folder):
    """A page that loads, is pulled by a mouse, moves, turns, and ends the program when it is closed."""
    out = folder / "out"
    program = Program(springproof, case, "--out", out)
    with Browser() as browser:
        page = browser.open(program.address)
        page.wait_until("typeof seen !== 'undefined' && seen.frames > 5")
        other = browser.open(program.address)
        other.wait_until("document.getElementById('state')?.textContent.includes('another page')")
        other.close()
        before = page.value("Array.from(surface.positions)")
        x, y = page.value("(() => { const at = new THREE.Vector3(20, 0, 45).project(view.camera), box = canvas.getBoundingClientRect();"
                          "return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height]; })()")
        page.mouse("mousePressed", x, y)
        for step in range(1, 11):
            page.mouse("mouseMoved", x + 14 * step, y - 6 * step)
        page.wait_until("frame.held >= 0 && frame.force > 0")
        page.wait_until(f"Math.max(...surface.positions.map((at, i) => Math.abs(at - ({json.dumps(before)})[i]))) > 3")
        page.screenshot(folder / "pulled.png")
        eye = page.value("view.camera.position.toArray()")
        page.mouse("mouseReleased", x + 140, y - 60, buttons=0)
        page.wait_until("frame.held < 0")
        for where, kind in ((700, "mousePressed"), (760, "mouseMoved"), (760, "mouseReleased")):
            page.mouse(kind, where, 700, buttons=0 if kind == "mouseReleased" else 1)
        page.wait_until("Math.abs(view.camera.position.x - " + str(eye[0]) + ") > 1e-3")
        numbers = page.value("({rate: seen.rate, latency: seen.latency_ms, answer: seen.answer_ms, resolution: view.resolution, pictures: seen.pictures, bytes: seen.bytes, median: frame.median_ms, rows: document.querySelectorAll('dt').length})")
        assert numbers["rows"] == 13, numbers
        latency = sorted(numbers.pop("latency"))
        assert latency and all(0 < value < 30000 for value in latency), latency
        numbers["latency_median_ms"] = latency[len(latency) // 2]
        problems = [problem for problem in page.problems() if "favicon" not in str(problem)]
        assert problems == [], problems
        page.close()
        summary = program.end()  # ends by itself: its page is closed
    assert summary["pulled_steps"] > 0 and summary["failed_steps"] == 0, summary
    rows = list(csv.DictReader(open(summary["recording"])))
    assert len(rows) == summary["pulled_steps"], (len(rows), summary)
    steps = [int(row["step"]) for row in rows]
    assert steps == sorted(set(steps))
    assert all(math.isfinite(float(value)) for row in rows for value in row.values())
    return numbers


def main():
    springproof, case, folder = sys.argv[1], *map(Path, sys.argv[2:4])
    count = int(sys.argv[4]) if len(sys.argv) > 4 else 1000
    folder.mkdir(parents=True, exist_ok=True)
    folder = folder.resolve()
    program = Program(springproof, case, "--stay")
    n_refused = check_refusals(program)
    check_pull(program)
    check_stalled(program)
    check_crowd(program)
    n_cut_off = check_malformed(program, count)
    assert n_cut_off > count / 2, n_cut_off
    summary = program.interrupt()
    assert summary["failed_steps"] == summary["unfinished_steps"] == 0 and summary["frames"]["with_inverted_cells"] == 0, summary
    assert summary["refused_requests"] >= n_refused, summary
    print(f"{n_refused} kinds of requests refused, {n_cut_off} of {count} mutated messages cut off; {summary}")
    check_recordings(springproof, case, folder)
    if not find_chromium():
        print("no Chromium here: the page itself was not opened, the test is skipped")
        return
    print(f"in Chromium: {check_browser(springproof, case, folder)}")
    print(f"of a large surface: {check_coarse_picture(springproof, case, folder)}")


if __name__ == "__main__":
    main()
