"""Runs of other versions: those of 0.1 and 0.2 are refused by every command; of others what need not compute their cells."""
import json
import pathlib
import unittest

from case import Case

RECORD = pathlib.Path(__file__).parent / "run_0_1.json"  # as that version wrote it
RUN = ["run", "q1", "--layout", "cells", "--scenarios", "heart", "--methods", "lga", "--demos", "10", "--seeds", "0",
       "--episodes", "4", "--out", "old"]


class OldRuns(Case):
    def setUp(self):
        super().setUp()
        (self.dir / "old").mkdir()

    def write(self, version):
        text = json.dumps({**json.loads(RECORD.read_text()), "version": version})
        (self.dir / "old/run.json").write_text(text)
        return text

    def test_are_refused_in_a_line(self):
        for version, some in (("0.1.0", slice(None)), ("0.2.0", slice(1))):
            before = self.write(version)
            for words in (["report", "old"], ["status", "old"], ["compare", "old", "old"], ["verify", "old"],
                          ["attribute", "old"], ["merge", "new", "old"], RUN, [*RUN, "--resume"])[some]:
                done = self.call(*words, expect=2)
                self.assertRegex(done.stderr, rf"\A(?:error: |lgabench: )?\S*old/run\.json: written by lgabench {version}, "
                                 r"whose runs 0\.\d+\.\d+ cannot read\n\Z", words)
                self.assertEqual(done.stdout, "")
            self.assertEqual([(path.name, path.read_text()) for path in (self.dir / "old").iterdir()],
                             [("run.json", before)])

    def test_of_a_version_with_other_cells_are_not_gone_on_with(self):
        self.write("0.99.0")
        for words, said in ((["verify", "old"], r"old: lgabench 0\.99\.0 made this run, and .* computes other cells; verify it with 0\.99\.0"),
                            (RUN, r"old: a run of lgabench 0\.99\.0, which 0\.\d+\.\d+ cannot resume")):
            self.assertRegex(self.call(*words, expect=2).stderr, said)


if __name__ == "__main__":
    unittest.main()
