"""tests/fuzz/campaign --until, with a fuzzer that does nothing.

Usage: campaign_test.py SOURCE_DIR
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])
PROGRAMS = {"cmake/setup": "", "bin/cmake": "",
            # Executes up to 400 inputs a round, and notes how many it is asked for.
            "build/fuzz/bin/fuzz-reader": 'for word; do [[ $word != -runs=* ]] || n=${word#-runs=}; done; echo "$n" >>asked\n'
                                          'echo "#9 cov: 7 ft: 8"; echo "stat::number_of_executed_units: $((n < 400 ? n : 400))"'}


class Until(unittest.TestCase):
    def test_counts_what_all_campaigns_executed_together(self):
        with tempfile.TemporaryDirectory() as directory:
            tree = pathlib.Path(directory)
            (tree / "tests/fuzz/corpus/reader").mkdir(parents=True)
            shutil.copy(SOURCE / "tests/fuzz/campaign", tree / "tests/fuzz")
            for name, script in PROGRAMS.items():
                (tree / name).parent.mkdir(parents=True, exist_ok=True)
                (tree / name).write_text(f"#!/bin/bash\n{script}\n")
                (tree / name).chmod(0o755)
            for count, asked in ((300, "300\n"), (1000, "300\n700\n300\n"), (1000, "300\n700\n300\n")):
                subprocess.run(["tests/fuzz/campaign", "--until", str(count), "reader"], cwd=tree, check=True, stdout=subprocess.DEVNULL,
                               env={**os.environ, "PATH": f"{tree}/bin:{os.environ['PATH']}"})
                self.assertEqual((tree / "asked").read_text(), asked)
            self.assertRegex((tree / "build/fuzz/executions").read_text(), r"^reader 1000 7 \d+\n$")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
