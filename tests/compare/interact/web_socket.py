"""A client of web sockets and of plain HTTP, of Python's standard library alone, that may also say what no browser says."""

import base64
import os
import socket
import struct
import urllib.parse


def request_text(address, path=None, method="GET", host=None, **headers):
    """A request for the address that the program has printed, with any part replaced; None leaves a header out."""
    url = urllib.parse.urlsplit(address)
    lines = [f"{method} {path if path is not None else url.path + '?' + url.query} HTTP/1.1"]
    sent = {"Host": host if host is not None else url.netloc, **{name.replace("_", "-"): value for name, value in headers.items()}}
    return "\r\n".join(lines + [f"{name}: {value}" for name, value in sent.items() if value is not None]) + "\r\n\r\n"


def connect(address):
    url = urllib.parse.urlsplit(address)
    return socket.create_connection((url.hostname, url.port), timeout=20)


def answer_to(address, text):
    """Status and body of what is answered to a request; (0, "") where the connection is closed without an answer."""
    with connect(address) as connection:
        answer = b""
        try:
            connection.sendall(text if isinstance(text, bytes) else text.encode())
            connection.shutdown(socket.SHUT_WR)
            while piece := connection.recv(65536):
                answer += piece
        except OSError:  # closed on us
            pass
    if not answer.startswith(b"HTTP/"):
        return 0, answer.decode("utf-8", "replace")
    head, _, body = answer.partition(b"\r\n\r\n")
    return int(head.split()[1]), body.decode("utf-8", "replace")


def handshake(address, **changed):
    url = urllib.parse.urlsplit(address)
    headers = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec_WebSocket_Version": "13",
               "Sec_WebSocket_Key": base64.b64encode(os.urandom(16)).decode(), "Origin": f"http://{url.netloc}"}
    return request_text(address, **{"path": f"/socket?{url.query}", **headers, **changed})


class WebSocket:
    """A page in control, by hand."""

    def __init__(self, address, **changed):
        self.connection = connect(address)
        self.connection.sendall(handshake(address, **changed).encode())
        self.buffer = b""
        head = self.take_until(b"\r\n\r\n")
        self.status = int(head.split()[1])

    def take_until(self, end):
        while end not in self.buffer:
            self.fill()
        head, _, self.buffer = self.buffer.partition(end)
        return head

    def fill(self):
        piece = self.connection.recv(1 << 16)
        if not piece:
            raise ConnectionError("closed")
        self.buffer += piece

    def take(self, size):
        while len(self.buffer) < size:
            self.fill()
        piece, self.buffer = self.buffer[:size], self.buffer[size:]
        return piece

    def send(self, content, opcode=None):
        if opcode is None:
            opcode = 1 if isinstance(content, str) else 2
        data = content.encode() if isinstance(content, str) else content
        length = len(data)
        head = bytes([0x80 | opcode])
        head += bytes([0x80 | length]) if length < 126 else bytes([0x80 | 126]) + struct.pack("!H", length) if length < 65536 else \
            bytes([0x80 | 127]) + struct.pack("!Q", length)
        mask = os.urandom(4)
        self.connection.sendall(head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def receive(self):
        """(opcode, content) of the next message; pings are answered."""
        while True:
            first, second = self.take(2)
            length = second & 127
            if length == 126:
                length, = struct.unpack("!H", self.take(2))
            elif length == 127:
                length, = struct.unpack("!Q", self.take(8))
            content = self.take(length)
            if first & 15 != 9:
                return first & 15, content
            self.send(content, 10)

    def close(self):
        self.connection.close()
