"""The Python host's frames, on the corpus of the fuzz target `frames` and on 5,000 seeded variations of it.

Usage: python_frames_test.py SOURCE_DIR
"""
import importlib.util
import pathlib
import random
import socket
import struct
import sys
import unittest
import zlib

SOURCE = pathlib.Path(sys.argv[1])
spec = importlib.util.spec_from_file_location("frames", SOURCE / "python/lgabench_method/frames.py")
frames = importlib.util.module_from_spec(spec)  # alone: the package itself needs NumPy
spec.loader.exec_module(frames)


def with_checksums(data):
    """Chance finds none."""
    data, at = bytearray(data), 0
    while len(data) - at >= frames.PREFIX.size:
        _, header, payload, _ = frames.PREFIX.unpack_from(data, at)
        begin, at = at + frames.PREFIX.size, at + frames.PREFIX.size + header + payload
        if at > len(data):
            break
        struct.pack_into("<I", data, begin - 4, zlib.crc32(data[begin:at]))
    return bytes(data)


def received(data):
    """Headers of the whole frames; None at their end where what follows is refused."""
    ours, theirs = socket.socketpair(socket.AF_UNIX)
    theirs.sendall(data)
    theirs.close()
    headers = []
    with ours:
        try:
            while (frame := frames.Channel(ours).receive()) is not None:
                headers.append(frame[0])
        except frames.Malformed:
            headers.append(None)
    return headers


def varied(data, draw):
    """A few bytes changed, put in or left out; in half of them the first frame's header fits its length again."""
    header, payload = frames.PREFIX.unpack_from(data)[1:3]
    whole = len(data) >= frames.PREFIX.size + header + payload
    begin = frames.PREFIX.size if whole and draw.random() < 0.5 else 0
    text = bytearray(data[begin:begin + header] if begin else data)
    for _ in range(draw.randint(1, 6)):
        at = draw.randrange(len(text) + 1)
        how = draw.randrange(3)
        if how == 0 and at < len(text):
            text[at] = draw.randrange(256)
        elif how == 1:
            text[at:at] = draw.choice([b"[", b"]", b"{", b'"', b"\xff", b"\0", b"[" * 3000, b"NaN", b"null"])
        else:
            del text[at:at + draw.randint(1, 20)]
    if begin:
        return frames.PREFIX.pack(frames.MAGIC, len(text), payload, 0) + text + data[begin + header:]
    return bytes(text)


class Frames(unittest.TestCase):
    corpus = [file.read_bytes() for file in sorted((SOURCE / "tests/fuzz/corpus/frames").iterdir())]

    def test_what_a_worker_sends(self):
        whole = (SOURCE / "tests/fuzz/corpus/frames/conversation").read_bytes()
        self.assertEqual([header["type"] for header in received(whole)], ["needs", "action", "epoch"])

    def test_headers_that_are_none_are_malformed(self):
        for text in b"[]", b"3", b"{}", b'{"type": 1}', b"{", b"\xff", b"[" * 100_000:
            data = frames.PREFIX.pack(frames.MAGIC, len(text), 0, zlib.crc32(text)) + text
            self.assertEqual(received(data), [None], text[:20])

    def test_any_bytes_are_frames_or_malformed(self):
        draw = random.Random(15)
        for data in self.corpus:
            received(data)
        for _ in range(5000):
            for header in received(with_checksums(varied(draw.choice(self.corpus), draw))):
                self.assertTrue(header is None or isinstance(header["type"], str))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
