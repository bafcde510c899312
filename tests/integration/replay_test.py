"""lgabench replay: a recorded episode played again ends as recorded, and is drawn.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 replay_test.py Replay
"""
import json
import re
import struct

import unittest

from case import FULL, BesideOneRun


class Replay(BesideOneRun):
    run_of_class = ("run", "q1", "--scenarios", "heart,rotate_block,sweep_block_without_touching_pan", "--methods", "lga",
                    "--demos", "3", "--seeds", "0", "--episodes", "3", "--set", "*.epochs=20")

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("out")

    def episodes(self):
        for key, (cell, _) in sorted(self.cells("out").items()):
            for line in (self.dir / "out/cells" / key / "episodes.jsonl").read_text().splitlines():
                yield key, cell["scenario"]["id"], json.loads(line)

    def light_colours(self, file):
        palette = (self.dir / file).read_bytes()[13:13 + 3 * 255]
        return sum(min(palette[i:i + 3]) > 215 for i in range(0, len(palette), 3))

    def test_each_ends_as_recorded(self):
        outcomes = set()
        for key, scenario, episode in self.episodes():
            expected = "success" if episode["success"] else episode["failure"]
            if (scenario, expected) in outcomes and not FULL:
                continue
            said = self.call("replay", "out", f"{key}/test/{episode['index']}", "--out", "e.gif").stdout
            self.assertRegex(said, rf"^e.gif: \d+ frames; {expected} as recorded$")
            outcomes.add((scenario, expected))
            bytes_ = (self.dir / "e.gif").read_bytes()
            self.assertTrue(bytes_.startswith(b"GIF89a") and bytes_.endswith(b"\x3b"))
            frames = int(re.search(r"(\d+) frames", said)[1])
            self.assertEqual(bytes_.count(b"\x21\xf9\x04"), frames)
            self.assertGreater(frames, 10 if expected == "success" else 1)
        self.assertGreater(len(outcomes), 5)

    def test_several_are_drawn_beside_each_other_after_what_their_policies_see(self):
        self.call("run", "q1", "--scenarios", "heart", "--methods", "human,gcbc_seg", "--demos", "3", "--seeds", "0", "--episodes", "1",
                  "--set", "*.epochs=2", "--no-reference", "--out", "two")
        keys = {cell["method"]["id"]: key for key, (cell, _) in self.cells("two").items()}
        episodes = [f"{keys[name]}/test/0" for name in ("human", "gcbc_seg")]
        said = self.call("replay", "two", *episodes, "--out", "e.gif").stdout
        self.assertRegex(said, r"^e.gif: \d+ frames; human; \w+ as recorded \| gcbc_seg; \w+ as recorded$")
        frames = int(re.search(r"(\d+) frames", said)[1])
        alone = [self.call("replay", "two", one, "--out", "one.gif").stdout for one in episodes]
        self.assertEqual(frames, 1 + max(int(re.search(r"(\d+) frames", one)[1]) for one in alone))
        both, single = (self.dir / "e.gif").read_bytes(), (self.dir / "one.gif").read_bytes()
        width, height = struct.unpack("<HH", both[6:10])
        of_one = [2 * side // 3 for side in struct.unpack("<HH", single[6:10])]
        self.assertEqual([width, height], [2 * of_one[0] + 16, of_one[1]])
        # What a policy does not see is faded in the first frame, which is held; whoever sees all has no such colours.
        self.call("replay", "two", episodes[1], episodes[1], "--out", "seg.gif")
        self.assertGreater(self.light_colours("e.gif"), 5 + self.light_colours("seg.gif"))
        self.assertIn("expected --out FILE.gif", self.call("replay", "two", *episodes, "--out", "e.png", expect=2).stderr)

    def test_a_changed_record_is_seen(self):
        key, _, episode = next(e for e in self.episodes() if e[2]["success"])
        file = self.dir / "out/cells" / key / "episodes.jsonl"
        line = json.dumps({**episode, "failure": "wrong_object", "success": False})
        file.write_text(line + "\n")
        said = self.call("replay", "out", f"{key[:6]}/{episode['index']}", "--out", "e.png").stdout
        self.assertIn("success here, recorded as wrong_object", said)
        self.assertTrue((self.dir / "e.png").read_bytes().startswith(b"\x89PNG"))
        file.write_text(line.replace(episode["scene"], "0" * 16) + "\n")
        self.assertIn("another scene", self.call("replay", "out", f"{key}/{episode['index']}", "--out", "e.png", expect=2).stderr)

    def test_what_is_wrong_is_said(self):
        key = next(iter(self.cells("out")))
        for episode, out, reason in [(f"{key}/test/3", "e.gif", "has no episode 3 in arm test"),
                                     (f"{key}/nope/0", "e.gif", 'arm "nope"'), (key, "e.gif", "expected KEY/ARM/INDEX"),
                                     ("zz/0", "e.gif", 'begins with "zz"'), (f"{key}/0", "e.mp4", "FILE.gif or FILE.png"),
                                     ("/0", "e.gif", "no cell")]:
            with self.subTest(episode):
                self.assertIn(reason, self.call("replay", "out", episode, "--out", out, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
