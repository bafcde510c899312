"""The frames of docs/formats/method-protocol.md, over a connected AF_UNIX socket."""
import json
import os
import socket
import stat
import struct
import zlib

MAGIC = b"LGA1"
PREFIX = struct.Struct("<4sIII")
MOST = 1 << 20


class Malformed(Exception):
    """What came is no frame, or is not the one that may come."""


def _header(text):
    try:
        header = json.loads(text.decode())
    except (ValueError, RecursionError) as error:
        raise Malformed(f"the header is no JSON: {error}") from None
    if not isinstance(header, dict) or not isinstance(header.get("type"), str):
        raise Malformed("the header is no object with a \"type\"")
    return header


class Channel:
    """One end of the socket. A process that a method forked ends where it sends: only the first one speaks."""

    def __init__(self, connection):
        self.socket = connection
        self.owner = os.getpid()

    def is_open(self):
        """Whether its descriptor still is a socket: a plugin may close it, or put another file there."""
        try:
            return stat.S_ISSOCK(os.fstat(self.socket.fileno()).st_mode)
        except OSError:
            return False

    def send(self, header, payload=b""):
        if os.getpid() != self.owner:
            os._exit(1)
        text = json.dumps(header, allow_nan=False).encode()
        if max(len(text), len(payload)) > MOST:
            raise ValueError(f"a frame \"{header['type']}\" with a header of {len(text)} and a payload of {len(payload)} bytes is "
                             "over the limits")
        self.socket.sendall(PREFIX.pack(MAGIC, len(text), len(payload), zlib.crc32(payload, zlib.crc32(text)))
                            + text + payload)

    def receive(self):
        """(header, payload, descriptor or None); None once the worker is gone."""
        files = []
        prefix = self._take(PREFIX.size, files)
        if prefix is None:
            return None
        magic, header_bytes, payload_bytes, crc = PREFIX.unpack(prefix)
        if magic != MAGIC or max(header_bytes, payload_bytes) > MOST:
            raise Malformed("its first bytes are not those of a frame")
        text, payload = self._take(header_bytes, files), self._take(payload_bytes, files)
        if text is None or payload is None:
            return None
        if zlib.crc32(payload, zlib.crc32(text)) != crc:
            raise Malformed("its checksum does not match")
        for extra in files[1:]:
            os.close(extra)
        return _header(text), payload, files[0] if files else None

    def _take(self, size, files):
        taken = bytearray()
        while len(taken) < size:
            data, descriptors, _, _ = socket.recv_fds(self.socket, size - len(taken), 1)
            files += descriptors
            if not data:
                return None
            taken += data
        return bytes(taken)
