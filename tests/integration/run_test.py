"""The programs as a person uses them: bad input, determinism, shards, demonstrations, gallery.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 run_test.py BadInput
"""
import base64
import ctypes
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import struct
import subprocess
import unittest

from case import BUILD, Case, FIXTURES, NO_CLOCK, PROGRAM, command_line, some_of

# Small but real: both shipped methods train, for seconds.
SMALL = ["q1", "--scenarios", "heart,letter", "--methods", "lga,gcbc_dart", "--demos", "10", "--seeds", "0",
         "--episodes", "4", "--set", "lga.epochs=200", "--set", "gcbc_dart.epochs=5"]
SMALL_CELLS = 2 * 6  # scenarios x (methods + constant action + most demonstrated + random object + oracle)


class BadInput(Case):
    def refused(self, *arguments, says, expect=2):
        done = self.call(*arguments, expect=expect)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertRegex(done.stderr, says)

    def test_command_line(self):
        for arguments, says in [
            (["q9"], r'no suite "q9", expected one of: .*q1'),
            (["q1", "--scenarios", "nope"], r'--scenarios: no scenario "nope", expected one of \d+, such as: '),
            (["q1", "--demos=-5"], r"--demos: expected a whole number from 0 .*got -5"),
            (["q1", "--demos", "10,ten"], r"--demos: expected whole numbers.*got \"ten\""),
            (["q1", "--selection-errors", "missing=0.1,extra=0.1"], r"--selection-errors: expected none, missing=P.*got \"extra=0.1\""),
            (["q1", "--selection-errors", "missing=1.5"], r"--selection-errors: expected a number from 0 to 1"),
            (["q1", "--train-on", "sensor_noise"], r"--train-on: expected AXIS:LEVEL or AXIS:any, such as sensor_noise:2; got \"sensor_noise\""),
            (["q1", "--train-on", "sensor_noise:9"], r"--train-on: expected a level from 1 to 4 \("),
            (["q1", "--train-on", "selection_errors:1"], r"--train-on: expected an axis that changes only the observation \(light_intensity, .*, got selection_errors"),
            (["q1", "--train-on", "moon:any"], r'--train-on: no axis "moon", expected one of: light_intensity'),
            (["perturbations", "--axes", "camera_trun"], r'--axes: no axis "camera_trun" \(did you mean "camera_turn"\?\)'),
            (["perturbations", "--axes", "camera_turn:1+7"], r"--axes: camera_turn has no level 7 here, expected one of: 1, 2, 3, 4"),
            (["perturbations", "--axes", "camera_turn:many"], r'--axes: expected AXIS or AXIS:LEVEL\+LEVEL, each level once, such as camera_turn:1\+4; got "camera_turn:many"'),
            (["perturbations", "--arms", "contrl"], r'--arms: no arm "contrl" \(did you mean "control"\?\)'),
            (["q1", "--axes", "camera_turn"], r"--axes: q1 has no perturbations here"),
            (["perturbations", "--engines", "kinematic", "--axes", "friction_mass:1", "--dry-run"], r"friction_mass on the engine kinematic"),
            (["q1", "--demos", "10,10"], r"--demos: expected each value once"),
            (["q1", "--episodes=-1"], r"--episodes: .*got -1"),
            (["q1", "--episodes", "0"], r"--episodes: .*got 0"),
            (["q1", "--scene-seed=-1"], r"--scene-seed: expected a whole number from 0 .*got -1"),
            (["q1", "--scene-seed", "some"], r"--scene-seed: expected a whole number from 0 .*got some"),
            (["q1", "--preset", "leaderboard", "--scene-seed", "7"], r"--scene-seed: preset leaderboard of q1 is the leaderboard's"),
            (["clutter", "--preset", "abstraction", "--scene-seed", "7", "--dry-run"], r"--scene-seed: preset abstraction of clutter is the leaderboard's"),
            (["q1", "--seeds", "3:1"], r"--seeds: .*3:1 has 0"),
            (["q1", "--layout", "moon"], r'--layout: no layout "moon", expected one of: cells, continuous, released$'),
            (["q1", "--layout", "table"], r'scenario red_heart \(tabletop\): no layout "table", expected one of: cells, continuous, released'),
            (["mobile", "--layout", "cells", "--dry-run"], r'scenario \w+ \(mobile\): no layout "cells", expected one of: table'),
            (["q1", "--preset", "nope"], r'q1.json: no preset "nope", expected one of: leaderboard, paper, paper_text, smoke'),
            (["q1", "--set", "lga.epocs=3"], r'unknown member "epocs" \(did you mean "epochs"\?\), expected one of: .*epochs'),
            (["q1", "--set", "lga.epochs=many"], r"/epochs: expected a whole number, got \"many\""),
            (["q1", "--set", "lga.epochs=soon"], r"/epochs: expected a whole number, got \"soon\""),
            (["q1", "--set", "lga.epochs=-3"], r"/epochs: expected a whole number of 1 or more, got -3"),
            (["q1", "--set", "*.epocs=3"], r'--set: /\*: unknown member "epocs".*, expected one of: .*epochs'),
            (["q1", "--set", "other.x=1"], r"--set other: expected a method of this run: lga, lga_hill, human"),
            (["q1", "--methods", "lga,lga+loss=norm"], r'"lga" and "lga\+loss=norm" are the same row, lga'),
            (["q1", "--methods", "lga+loss"], r'method "lga\+loss": expected ID\+OPTION=VALUE'),
            (["q1", "--jobs", "0"], r"--jobs"),
            (["q1", "--resume", "--fresh"], r"excludes"),
        ]:
            with self.subTest(arguments):
                self.refused("run", *arguments, says=says)
        self.refused("run", "q1", "--methods", "nope", says=r'no method "nope", expected one of: .*gcbc_dart, .*lga', expect=4)
        self.refused("run", "q1", "--engines", "nope", says=r'no engine "nope"', expect=4)
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_suite_file(self):
        good = json.loads((BUILD / "share/lgabench/suites/q1.json").read_text())
        file = self.dir / "q1.json"
        for change, says in [
            ({"episodes": -1}, r"q1.json: /episodes: expected a whole number from 1 to \d+, got -1"),
            ({"scenarios": ["heart", "nope"]}, r'q1.json: /scenarios/1: no scenario "nope", expected one of \d+, such as: '),
            ({"scenarios": []}, r"q1.json: /scenarios: expected at least one value"),
            ({"colour": 1}, r"q1.json: /: unknown member \"colour\""),
            ({"id": "other"}, r"q1.json: /id: expected \"q1\""),
            ({"presets": {"smoke": {"seeds": [-1]}}}, r"q1.json: /presets/smoke/seeds/0: "),
            ({"presets": {"p": {"options": {"nope": {}}}}}, r"q1.json: /presets/p/options: unknown member \"nope\""),
            ({"options": {"lga": {"epocs": 3}}}, r"q1.json: /options/lga: unknown member \"epocs\""),
            ({"options": {"*": {"loss": "cubed"}}}, r"q1.json: /options/\*/loss: expected one of"),
            ({"test_scenes": "mine"}, r"q1.json: /test_scenes: expected shared or per_seed"),
            ({"environment": "kitchen"}, r'no environment "kitchen"'),
        ]:
            with self.subTest(change):
                file.write_text(json.dumps({**good, **change}))
                self.refused("run", file, says=says)
        file.write_text('{"id": "q1",\n "scenarios": [}')
        self.refused("run", file, says=r"q1.json: line 2 \(byte \d+\): expected valid JSON")
        file.write_text(json.dumps({k: v for k, v in good.items() if k != "seeds"}))
        self.refused("run", file, says=r'q1.json: /: expected a member "seeds"')
        self.refused("run", self.dir / "none.json", says=r"none.json: cannot be read: No such file")

    def test_output_directory(self):
        (self.dir / "file").write_text("kept")
        self.refused("run", "q1", "--limit", "1", "--out", "file/below", says=r"file/below: .*file is not a directory")
        self.refused("run", "q1", "--limit", "1", "--out", "file", says=r"file: .*file is not a directory")
        (self.dir / "mine").mkdir()
        (self.dir / "mine" / "thesis.txt").write_text("kept")
        for flags in ([], ["--resume"], ["--fresh"]):
            self.refused("run", "q1", "--limit", "1", "--out", "mine", *flags, says=r"mine: not empty and not a run")
        self.assertEqual((self.dir / "file").read_text(), "kept")
        self.assertEqual([p.name for p in (self.dir / "mine").iterdir()], ["thesis.txt"])

    def test_a_record_without_end(self):
        """A run.json takes no more memory than a run of any size needs."""
        (self.dir / "run").mkdir()
        (self.dir / "run/run.json").write_text('{"unknown": [' + "[]," * (20 << 20) + "[]]}")
        for verb in ("status", "report"):
            done = self.call(verb, "run", expect=2, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 29,) * 2))
            self.assertRegex(done.stderr, r"^lgabench: run/run.json: cannot be read: \d+ bytes or more, expected at most 8388608\n$")

    def test_another_configuration_is_not_overwritten(self):
        one = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--set", "lga.epochs=5",
               "--methods", "lga", "--out", "out"]
        self.call(*one, "--episodes", "2")
        before = self.results("out")
        for flags in ([], ["--resume"]):
            self.refused(*one, "--episodes", "3", *flags, says=r"out: holds another run \(episodes 2 there, 3 wanted\)")
        self.assertEqual(self.results("out"), before)
        self.call(*one, "--episodes", "3", "--fresh")
        self.assertEqual({cell["episodes"] for cell, _ in self.cells("out").values()}, {3})

    def test_hdf5(self):
        (self.dir / "not.hdf5").write_text("this is text")
        self.refused("demos", "--inspect", "not.hdf5", says=r"not.hdf5: /: expected an HDF5 file")
        (self.dir / "cut.hdf5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        self.refused("demos", "--inspect", "cut.hdf5", says=r"cut.hdf5: /")
        self.refused("demos", "heart", "--out", "not.hdf5/x", says=r"not.hdf5/x: cannot be written: .*not.hdf5 is not a directory")
        self.refused("demos", "nope", "--out", "x.hdf5", says=r'no scenario "nope", expected one of \d+, such as: ')
        self.refused("demos", "heart", "--n=-1", "--out", "x.hdf5", says=r"--n")


class OptionsOfOthers(Case):
    """A plugin whose options have names of the framework's, and mean something else."""
    PLUGINS = ["--plugin-path", FIXTURES / "good", "--plugin-path", FIXTURES / "faulty"]

    def test_every_shipped_suite_takes_it(self):
        names = sorted((BUILD / "share/lgabench/suites").glob("*.json"))
        self.assertGreater(len(names), 5)
        for file in names:
            for preset in some_of([None, *json.loads(file.read_text())["presets"]]):
                with self.subTest(suite=file.stem, preset=preset):
                    self.call("run", file.stem, *(["--preset", preset] if preset else []), *self.PLUGINS, "--methods",
                              "fixture_own_loss,fixture_own_network", "--dry-run", *(["--answers", "none", "--demos", "1"] if file.stem == "persons" else []))

    def test_it_keeps_its_own_and_none_is_mistaken(self):
        run = ["run", "q1", "--scenarios", "heart", *self.PLUGINS, "--demos", "10", "--seeds", "0", "--episodes", "2",
               "--set", "*.epochs=2", "--no-reference", "--out", "out", "--methods"]
        self.call(*run, "fixture_own_loss,fixture_own_network", expect=3)
        found = {cell["method"]["id"]: (cell["method"]["options"], status) for cell, status in self.cells("out").values()}
        options, status = found["fixture_own_loss"]
        self.assertEqual((options["loss"], options["batches"], status["state"]), ("huber", "drawn", "ok"))
        options, status = found["fixture_own_network"]
        self.assertEqual((options["network"], status["state"]), ("resnet", "failed"))
        self.assertIn('options: /network: expected one of text, released, plain, spot, got "resnet"', status["reason"])
        self.assertIn('--set: /*/loss: expected one of ["huber"]',
                      self.call(*run, "fixture_own_loss", "--set", "*.loss=norm", expect=2).stderr)


class Variants(Case):
    def test_are_rows_of_their_own(self):
        arguments = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "4", "--out", "out",
                     "--tables", "--methods", "lga+epochs=5,lga+loss=squared,factorial", "--set", "lga.epochs=6",
                     "--set", "factorial.epochs=5"]
        table = self.call(*arguments).stdout
        self.assert_matches_schemas("out")
        rows = {row["method"] for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]
                if row["method_kind"] == "method"}
        self.assertEqual(rows, {"lga+epochs=5", "lga+loss=squared", "factorial"})
        for shown in ("LGA epochs=5 ", "LGA loss=squared ", "factorial "):
            self.assertIn("  " + shown, table)
        settings = json.loads((self.dir / "out/run.json").read_text())["settings"]
        self.assertEqual([settings[row]["epochs"] for row in ("lga+epochs=5", "lga+loss=squared", "factorial")], [5, 6, 5])
        self.assertIn("beside the plugins' defaults, epochs=6, loss=squared: LGA loss=squared\n", table)
        self.assertIn("0 cells computed, 7 reused", self.call(*arguments).stderr)

        # factorial with its defaults is LGA.
        results = {cell["method"]["name"]: [(self.dir / "out/cells" / key / name).read_bytes()
                                            for name in ("selection.json", "training.jsonl", "episodes.jsonl")]
                   for key, (cell, _) in self.cells("out").items()}
        self.assertEqual(results["factorial"], results["lga+epochs=5"])
        self.assertNotEqual(results["lga+loss=squared"], results["lga+epochs=5"])


class Presets(Case):
    """A suite of the test's own: options of a preset, and test scenes of each training seed's own."""

    def test_options_and_test_scenes(self):
        suite = json.loads((BUILD / "share/lgabench/suites/q1.json").read_text())
        suite.update(scenarios=["heart"], methods=["lga", "lga+loss=squared"], demonstrations=[10], seeds=[0, 1],
                     episodes=3, options={"*": {"epochs": 7}},
                     presets={"own": {"test_scenes": "per_seed", "options": {"*": {"epochs": 5}, "lga": {"batch_size": 5}}}})
        (self.dir / "q1.json").write_text(json.dumps(suite))
        table = self.call("run", "q1.json", "--preset", "own", "--out", "own", "--tables", "--set", "*.learning_rate=0.002").stdout
        self.call("run", "q1.json", "--out", "shared")
        self.assert_matches_schemas("own")
        for line in ("q1: preset own\n", "q1: each training seed plays test scenes of its own\n",
                     "batch_size=5, epochs=5, learning_rate=0.002: LGA\n"):
            self.assertIn(line, table)
        scenes = {}
        for run in ("own", "shared"):
            for key, (cell, _) in self.cells(run).items():
                options = cell["method"]["options"]
                if cell["method"]["id"] == "lga":
                    self.assertEqual((options["epochs"], options["batch_size"]), (5, 5) if run == "own" else (7, 10))
                lines = (self.dir / run / "cells" / key / "episodes.jsonl").read_text().splitlines()
                scenes.setdefault((run, cell["training_seed"]), set()).add(tuple(json.loads(l)["scene"] for l in lines))
        self.assertEqual([len(each) for each in scenes.values()], [1] * 4)
        self.assertEqual(scenes["shared", 0], scenes["shared", 1])
        self.assertEqual(len(set().union(*scenes.values())), 3)
        oracles = [cell["training_seed"] for cell, _ in self.cells("own").values() if cell["method"]["id"] == "oracle"]
        self.assertEqual(sorted(oracles), [0, 1])
        # The page draws each failed scene as it was played.
        self.assertNotIn("samples another scene", (self.dir / "own/report.html").read_text())


class SceneSeed(Case):
    RUN = ["run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--demos", "3", "--seeds", "0", "--episodes", "2",
           "--plugin-path", FIXTURES / "good"]

    def scenes(self, run):
        return {json.loads(line)["scene"] for key in self.cells(run)
                for line in (self.dir / run / "cells" / key / "episodes.jsonl").read_text().splitlines()}

    def test_draws_other_test_scenes_and_the_same_demonstrations(self):
        self.call(*self.RUN, "--out", "own")
        shown = {file.name: file.read_bytes() for file in (self.dir / "cache").iterdir()}
        self.assertTrue(shown)
        said = self.call(*self.RUN, "--scene-seed", "7", "--out", "other").stderr
        self.assertIn("--scene-seed 7: the test scenes are new; the demonstrations stay, as the training seeds draw them\n", said)
        self.assertEqual({file.name: file.read_bytes() for file in (self.dir / "cache").iterdir()}, shown)
        self.assertFalse(self.scenes("own") & self.scenes("other"))
        self.assertEqual(json.loads((self.dir / "other/run.json").read_text())["request"]["scene_seed"], 7)
        self.assertEqual({cell["scene_seed"] for cell, _ in self.cells("other").values()}, {7})
        self.assertNotIn("--scene-seed", self.call(*self.RUN, "--scene-seed", "7", "--out", "quiet", "--quiet").stderr)
        self.assert_same_results("other", "quiet")
        self.assertIn("bit-identical", self.call("verify", "other", "--all", "--plugin-path", FIXTURES / "good").stdout)
        self.assertIn("scene_seed", self.call("merge", "both", "own", "other", expect=2).stderr)
        self.assertIn("the runs cannot be compared: no cell played the same scenes in both",
                      self.call("compare", "own", "other", expect=2).stderr)
        # The default is the suite's own, and the cell the same.
        self.call(*self.RUN, "--scene-seed", "0", "--out", "zero")
        self.assert_same_results("own", "zero")


class Determinism(Case):
    def test_jobs_cache_and_repetition_change_no_byte(self):
        self.call("run", *SMALL, "--jobs", "1", "--out", "one")
        self.assertEqual(len(self.cells("one")), SMALL_CELLS)
        self.assertEqual({status["state"] for _, status in self.cells("one").values()}, {"ok"})
        self.call("run", *SMALL, "--jobs", "2", "--out", "two", "--cache", self.dir / "another")
        self.assert_same_results("one", "two")
        cached = {p.name: p.read_bytes() for p in (self.dir / "cache").iterdir()}
        self.assertEqual(cached, {p.name: p.read_bytes() for p in (self.dir / "another").iterdir()})
        self.call("run", *SMALL, "--jobs", "2", "--out", "two", "--fresh")  # from the filled cache
        self.assert_same_results("one", "two")

        # Test scenes are the same for every method and training seed.
        scenes = {}
        for key, (cell, _) in self.cells("one").items():
            lines = (self.dir / "one/cells" / key / "episodes.jsonl").read_text().splitlines()
            scenes.setdefault(cell["scenario"]["id"], set()).add(tuple(json.loads(line)["scene"] for line in lines))
        self.assertEqual({scenario: len(kinds) for scenario, kinds in scenes.items()}, {"heart": 1, "letter": 1})

        # A second call computes nothing; a damaged file is computed again, and that is said.
        self.assertIn(f"0 cells computed, {SMALL_CELLS} reused", self.call("run", *SMALL, "--out", "two").stderr)
        damaged = next((self.dir / "two/cells").glob("*/episodes.jsonl"))
        damaged.write_bytes(damaged.read_bytes()[:-10])
        said = self.call("run", *SMALL, "--out", "two").stderr
        self.assertRegex(said, r"episodes.jsonl changed since it was written; computed again")
        self.assertIn("1 cells computed", said)
        self.assert_same_results("one", "two")
        self.assert_matches_schemas("two")


class Unloadable(Case):
    def test_a_plugin_costs_its_own_cell_alone(self):
        done = self.call("run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "2",
                         "--no-reference", "--methods", "missing_symbol,fixture_constant", "--out", "out",
                         "--plugin-path", FIXTURES / "refused", "--plugin-path", FIXTURES / "good", expect=4)
        self.assertRegex(done.stderr, r"missing_symbol.*undefined symbol")
        self.assertEqual(sorted(status["state"] for _, status in self.cells("out").values()), ["failed", "ok"])


def times_opened(files, action):
    """How often the action opens each of the files."""
    libc, opens, closes = ctypes.CDLL(None), 0x20, 0x10  # IN_OPEN, IN_CLOSE_NOWRITE: equal events in a row count once
    watcher = libc.inotify_init1(os.O_NONBLOCK)
    watched = {libc.inotify_add_watch(watcher, os.fsencode(file), opens | closes): file for file in files}
    action()
    times = dict.fromkeys(files, 0)
    for watch, mask, _, _ in struct.iter_unpack("iIII", os.read(watcher, 1 << 20)):
        times[watched[watch]] += mask == opens
    os.close(watcher)
    return times


class Merging(Case):
    def test_rows_that_ask_nobody_go_with_any_answers(self):
        common = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "2", "--no-reference"]
        self.call(*common, "--methods", "lga+policy=centroid", "--out", "asked")
        self.call(*common, "--methods", "human+policy=centroid", "--answers", "none", "--out", "nobody")
        asked, nobody = (json.loads((self.dir / run / "run.json").read_text()) for run in ("asked", "nobody"))
        self.assertNotEqual(asked["request"]["answers"], nobody["request"]["answers"])
        for out, parts in {"one": ["asked", "nobody"], "other": ["nobody", "asked"]}.items():
            self.call("merge", out, *parts)
            merged = json.loads((self.dir / out / "run.json").read_text())
            self.assertEqual([merged["request"]["answers"], merged["answers"]], [asked["request"]["answers"], asked["answers"]], out)
            self.assertIn("2 bit-identical", self.call("verify", out, "--all").stdout)


class Shards(Case):
    RUN = ["run", "q1", "--scenarios", "heart,letter", "--methods",
           "fixture_constant,fixture_faulty+where=learn+how=throw", "--demos", "10,20", "--seeds", "0", "--episodes", "2", "--plugin-path", FIXTURES / "good",
           "--plugin-path", FIXTURES / "faulty"]
    CELLS, FAILED = 2 * (2 * 4 + 2), 2 * 2

    def test_merged_they_are_the_undisturbed_run(self):
        said = self.call(*self.RUN, "--out", "whole", "--jobs", "2", expect=3).stderr
        shares = re.search(r"^load (\d+) %, select (\d+) %, sample (\d+) %, demonstrate (\d+) %, learn (\d+) %, evaluate (\d+) %; "
                           r"2 workers busy (\d+) % of [\d.]+ s$", said, re.MULTILINE)
        *phases, busy = map(int, shares.groups())
        self.assertTrue(97 <= sum(phases) <= 103 and 0 < busy <= 101, shares[0])  # how busy is the machine's affair
        parts = []
        for shard in ("1/2", "2/2"):
            out = "part" + shard[0]
            said = self.call(*self.RUN, "--out", out, "--shard", shard, expect=3)
            self.assertIn(f"shard {shard}: {self.CELLS // 2} of the run's {self.CELLS} cells are not run here", said.stderr)
            self.assertIn(f"{self.CELLS // 2} of {self.CELLS} cells have not run yet", said.stdout)
            parts.append(set(self.cells(out)))
            # Each gets its share of every kind of cell.
            kinds = [(cell["method"]["name"], cell["demonstrations"]) for cell, _ in self.cells(out).values()]
            self.assertEqual(len(kinds), len(set(kinds)))
        self.assertEqual(parts[0] | parts[1], set(self.cells("whole")))
        said = self.call("merge", "both", "part1", "part2", expect=3)
        self.assertIn(f"{self.CELLS - self.FAILED} cells finished, {self.FAILED} failed, 0 left out, 0 in none", said.stderr)
        self.assert_same_results("whole", "both")
        self.assert_matches_schemas("both")
        whole, both = (json.loads((self.dir / run / "run.json").read_text()) for run in ("whole", "both"))
        own = ("command", "started", "merged")
        self.assertEqual(*({name: value for name, value in run.items() if name not in own} for run in (whole, both)))
        self.assertEqual([re.search(r"--shard (\S+)", part["command"])[1] for part in both["merged"]], ["1/2", "2/2"])
        self.assertEqual(self.call("merge", "both", "part1", "part2", expect=3).stdout, said.stdout)  # again
        self.assertNotIn("may not be bit-identical", said.stderr)
        record = self.dir / "part2/run.json"
        here = json.loads(record.read_text())["machine"]["instructions"]
        for machine, words in (({"processor": "Z80", "instructions": "AVX2"}, "Z80 with AVX2" if here == "without FMA" else None),
                               ({"processor": "Z80"}, "Z80, instructions not recorded")):
            shutil.copytree(self.dir / "part2", self.dir / "elsewhere", dirs_exist_ok=True)
            (self.dir / "elsewhere/run.json").write_text(json.dumps({**json.loads(record.read_text()), "machine": machine}))
            said_of_it = self.call("merge", "of_two", "part1", "elsewhere", expect=3).stderr
            self.assertEqual(f"elsewhere: computed on {words}, " in said_of_it, words is not None, said_of_it)
            shutil.rmtree(self.dir / "of_two")
        # A run like any other: it goes on, and only what failed is computed again.
        said = self.call(*self.RUN, "--out", "both", "--resume", expect=3).stderr
        self.assertIn(f"0 cells computed, {self.CELLS - self.FAILED} reused, {self.FAILED} failed", said)

        # A part alone, a damaged cell: what is not there is not run, and that is said.
        torn = next((self.dir / "part1/cells").glob("*/episodes.jsonl"))
        torn.write_bytes(b"")
        said = self.call("merge", "one", "part1", expect=3)
        self.assertRegex(said.stderr, rf"{torn.parent.name}.*episodes.jsonl changed since it was written.*left out")
        self.assertIn(f"1 left out, {self.CELLS // 2} in none of the runs", said.stderr)
        self.call("merge", "one", "part1", "part2", expect=3)  # once the other is there
        merged = json.loads((self.dir / "one/run.json").read_text())["merged"]
        self.assertEqual([re.search(r"--shard (\S+)", part["command"])[1] for part in merged], ["1/2", "2/2"])

    def test_what_is_no_part_is_refused(self):
        one = ["run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--demos", "10", "--seeds", "0",
               "--plugin-path", FIXTURES / "good", "--no-reference"]
        self.call(*one, "--episodes", "2", "--out", "a")
        self.call(*one, "--episodes", "3", "--out", "b")
        shutil.copytree(self.dir / "a", self.dir / "forged")
        cell = next((self.dir / "forged/cells").iterdir())
        (cell / "episodes.jsonl").write_bytes((cell / "episodes.jsonl").read_bytes().replace(b":1", b":0", 1))
        status = json.loads((cell / "status.json").read_text())
        status["files"]["episodes.jsonl"] = hashlib.sha256((cell / "episodes.jsonl").read_bytes()).hexdigest()
        (cell / "status.json").write_text(json.dumps(status))
        shutil.copytree(self.dir / "a", self.dir / "rebuilt")
        record = self.dir / "rebuilt/run.json"
        run = json.loads(record.read_text())
        run["build"]["lgabench-worker"] = "0" * 64
        record.write_text(json.dumps(run))
        for copy in ("without_plugin", "other_plugin"):
            shutil.copytree(self.dir / "a", self.dir / copy)
            record = self.dir / copy / "run.json"
            run = json.loads(record.read_text())
            plugin, = [plugin for plugin in run["plugins"] if plugin["kind"] == "method"]
            if copy == "without_plugin":
                run["plugins"].remove(plugin)
            else:
                plugin["sha256"] = "0" * 64
            record.write_text(json.dumps(run))
        for runs, says in [
            (["a", "b"], r"a and b are not parts of one run: other cells: episodes 2 there, 3 wanted"),
            (["a", "forged"], rf"a/cells/{cell.name} and forged/cells/{cell.name}: different results of one cell: episodes"),
            (["a", "rebuilt"], r"a and rebuilt are not parts of one run: different builds of lgabench-worker"),
            (["without_plugin", "a", "other_plugin"],
             r"a and other_plugin are not parts of one run: different builds of method fixture_constant"),
            (["a", "none"], r"none/run.json: cannot be read"),
        ]:
            with self.subTest(runs):
                done = self.call("merge", "out", *runs, expect=2)
                self.assertRegex(done.stderr, says)
                self.assertFalse((self.dir / "out").exists())
        self.assertRegex(self.call("merge", "a", "a", expect=2).stderr, r"a: both an input and OUT")
        for shard in ("0/2", "3/2", "1", "1/2/3", "x/2", "1/"):
            self.assertRegex(self.call(*one, "--shard", shard, expect=2).stderr, rf"--shard {shard}: expected i/n")

    def test_runs_of_other_methods_and_seeds_make_one(self):
        one = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--episodes", "2", "--plugin-path", FIXTURES / "good"]
        self.call(*one, "--methods", "fixture_constant", "--seeds", "0", "--out", "first")
        self.call(*one, "--methods", "fixture_constant", "--seeds", "0,1", "--no-reference", "--out", "seeds")
        self.call(*one, "--methods", "gcbc_seg+epochs=1", "--seeds", "0", "--no-reference", "--out", "method")
        self.call("merge", "all", "first", "seeds", "method")
        self.assert_matches_schemas("all")
        together = set().union(*(self.cells(run) for run in ("first", "seeds", "method")))
        self.assertEqual(set(self.cells("all")), together)
        run = json.loads((self.dir / "all/run.json").read_text())
        self.assertEqual(sorted(run["cells"]), sorted(together))
        self.assertEqual((run["request"]["methods"], run["request"]["seeds"], run["request"]["references"]),
                         (["fixture_constant", "gcbc_seg+epochs=1"], [0, 1], True))
        self.assertEqual({plugin["id"] for plugin in run["plugins"]} - {"mujoco", "bullet", "kinematic"}, {"fixture_constant", "gcbc_seg"})
        self.assertEqual(run["settings"], {"gcbc_seg": {"epochs": 1}} | json.loads(
            (self.dir / "first/run.json").read_text())["settings"])
        self.call("verify", "all", "--sample", "2", "--plugin-path", FIXTURES / "good")

    def test_runs_of_other_errors_make_one(self):
        one = ["run", "q1", "--scenarios", "heart", "--demos", "5", "--seeds", "0", "--episodes", "2", "--no-reference",
               "--methods", "lga+epochs=1"]
        self.call(*one, "--out", "exact")
        self.call(*one, "--selection-errors", "missing=0.4,added=0.2", "--out", "erring")
        none, errors = [{}], [{"missing": 0.4}, {"added": 0.2}]
        for parts, said in (("exact", "erring"), none + errors), (("erring", "exact"), errors + none):
            self.call("merge", parts[0] + "_first", *parts)
            self.assertEqual(set(self.cells(parts[0] + "_first")), {*self.cells("exact"), *self.cells("erring")})
            merged = self.dir / (parts[0] + "_first")
            self.assertEqual(json.loads((merged / "run.json").read_text())["request"]["selection_errors"], said)
            self.assertEqual({row["method"] for row in json.loads((merged / "summary.json").read_text())["rows"]},
                             {"lga", "lga+missing=0.4", "lga+added=0.2"})

    def test_each_file_is_read_once_to_judge_it_and_once_to_copy_it(self):
        one = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--episodes", "2", "--plugin-path", FIXTURES / "good",
               "--methods", "fixture_constant", "--no-reference"]
        for seed in "01":
            self.call(*one, "--seeds", seed, "--out", seed)
        statuses = [file for run in "01" for file in (self.dir / run / "cells").glob("*/status.json")]
        times = times_opened(statuses, lambda: self.call("merge", "both", "0", "1"))
        self.assertEqual(list(times.values()), [2, 2])

    def test_two_rows_of_one_name_are_refused(self):
        """Each is alone of its method in its run, and so named by the method."""
        one = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "2", "--no-reference"]
        for epochs in ("1", "2"):
            self.call(*one, "--methods", f"gcbc_seg+epochs={epochs}", "--out", epochs)
        said = self.call("merge", "both", "1", "2", expect=2).stderr
        self.assertRegex(said, r"[12]/cells/\w+ and [12]/cells/\w+ both are gcbc_seg heart continuous \w+ n=10 seed=0, and "
                               r"differ in method \(epochs\): .*--methods gcbc_seg\+epochs=1,gcbc_seg\+epochs=2, ")
        self.assertFalse((self.dir / "both").exists())

    def test_one_without_cells_says_so(self):
        said = self.call("run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--demos", "10",
                         "--seeds", "0", "--plugin-path", FIXTURES / "good", "--no-reference", "--shard", "2/2", "--out", "out")
        self.assertIn("shard 2/2: 1 of the run's 1 cells are not run here", said.stderr)
        self.assertEqual(said.stdout, "")


class Demonstrations(Case):
    def test_file(self):
        for name in ("a", "b"):
            self.call("demos", "heart", "--n", "3", "--noisy", "2", "--out", name + ".hdf5")
        data = (self.dir / "a.hdf5").read_bytes()
        self.assertEqual(data, (self.dir / "b.hdf5").read_bytes())
        lines = self.call("demos", "--inspect", "a.hdf5").stdout.splitlines()
        self.assertEqual(len(lines), 3)
        for i, line in enumerate(lines):
            self.assertRegex(line, rf'^demo_{i}: (1 step|[23] steps); "Bring me the heart."; .*heart')
        # It says where its scenes come from, what the command means, and nothing of them that a method is not told.
        data, selections = re.subn(rb'"provenance":"truth","target":', b"", data)
        self.assertEqual(selections, 3)
        for word in (b"role", b"target", b"distractor", b"goal", b"scene", b"index"):
            self.assertIsNone(re.search(rb"\b" + word, data), word)

    def test_of_what_a_method_selected(self):
        self.call("run", "q1", "--scenarios", "red_heart", "--methods", "lga", "--demos", "10", "--seeds", "0", "--episodes",
                  "1", "--layout", "cells", "--set", "lga.epochs=1", "--no-reference", "--out", "out")
        (key, _), = self.cells("out").items()
        selection = self.dir / "out/cells" / key / "selection.json"
        textures = json.loads(selection.read_text())["commands"][0]["selection"]["target"]["textures"]
        self.assertEqual(len(textures), 2, "of the five that count as red")
        self.call("demos", "red_heart", "--selection", selection, "--n", "10", "--out", "own.hdf5")
        for line in self.call("demos", "--inspect", "own.hdf5").stdout.splitlines():
            self.assertRegex(line, "|".join(f"{texture} heart" for texture in textures))
        self.call("demos", "red_heart", "--n", "10", "--out", "true.hdf5")
        self.assertNotEqual((self.dir / "own.hdf5").read_bytes(), (self.dir / "true.hdf5").read_bytes())
        said = self.call("demos", "q3_fruit", "--selection", selection, "--out", "no.hdf5", expect=2).stderr
        self.assertIn("one for each of the 3 commands of q3_fruit", said)

    def test_errors_of_a_selection_are_an_axis(self):
        grid = ("--scenarios", "heart,tiger_colored_object", "--demos", "2", "--seeds", "0", "--episodes", "2", "--layout", "cells",
                "--set", "*.epochs=1", "--no-reference")
        self.call("run", "q1", *grid, "--methods", "human,gcbc_dart", "--out", "out",
                  "--selection-errors", "none,missing=1,added=0.3,added=0.3+missing=0.1")
        cells = {(cell["scenario"]["id"], cell["method"]["name"]):
                 (key, cell, [json.loads(line) for line in (self.dir / "out/cells" / key / "episodes.jsonl").read_text().splitlines()])
                 for key, (cell, _) in self.cells("out").items()}
        self.assertEqual(len(cells), 2 * 2 * 4)
        self.assertNotIn("selection_errors", cells["heart", "human"][1])
        self.assertEqual(cells["heart", "human+added=0.3+missing=0.1"][1]["selection_errors"], {"added": .3, "missing": .1})
        for episode in cells["heart", "human+missing=1"][2]:
            self.assertEqual(episode["failure"], "abstraction_empty")
        for scenario in "heart", "tiger_colored_object":
            key = cells[scenario, "human+added=0.3"][0]
            command = json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"][0]
            used, before = command["selection"]["target"], command["before_errors"]["target"]
            for names in "object_types", "textures":
                self.assertEqual(set(before[names]) - set(used[names]), {"pallet"} & set(before[names]))
            self.assertNotIn("pallet", used["object_types"])
            quality = command["quality"]["target"]["textures" if scenario.startswith("tiger") else "object_types"]
            self.assertLess(quality["precision"], 1)
            actions = [[e["action"] for e in cells[scenario, name][2]] for name in ("gcbc_dart", "gcbc_dart+added=0.3")]
            self.assertEqual(*actions, "a method that selects nothing is not affected")
        self.assert_matches_schemas("out")
        summary = json.loads((self.dir / "out/summary.json").read_text())
        self.assertEqual({(c["method"], c["errors"]) for c in summary["error_curves"]},
                         {(m, e) for m in ("human", "gcbc_dart") for e in ("missing", "added")})
        self.call("verify", "out", "--sample", "3")

    def test_smoke_is_stamped(self):
        for flags, stamped in ([["--limit", "1"], True], [["--scenarios", "heart", "--seeds", "0", "--demos", "10"], False]):
            out = f"out{stamped}"
            self.call("run", "q1", "--methods", "lga", "--set", "lga.epochs=2", "--episodes", "1", "--out", out, *flags)
            self.assertEqual(json.loads((self.dir / out / "run.json").read_text())["smoke"], stamped)
            self.assertEqual({cell["smoke"] for cell, _ in self.cells(out).values()}, {stamped})


class Commands(Case):
    def test_both_streams_in_one_file_are_in_order(self):
        with open(self.dir / "log", "w") as log:
            subprocess.run(command_line("run", *SMALL, "--limit", "1", "--out", "run"), stdout=log, stderr=log, check=True,
                           env=self.environment, cwd=self.dir)
        log = (self.dir / "log").read_text()
        places = [log.index(words) for words in ("1 cells computed", "succeeds in", "\n  LGA ", "report: ")]
        self.assertEqual(places, sorted(places), log)

    def test_demonstrations_are_per_seen_command(self):
        arguments = ["--scenarios", "q3_fruit,q3_utensil", "--methods", "lga", "--demos", "10", "--seeds", "0",
                     "--episodes", "2", "--set", "lga.epochs=1", "--no-reference"]
        said = self.call("run", "q3", *arguments, "--tables", "--out", "out").stdout
        self.assertIn("demonstrations: 10 per command, 20 in all", said)
        for key, (cell, _) in self.cells("out").items():
            self.assertEqual(cell["demonstrations"], 10)
            line = json.loads((self.dir / "out/cells" / key / "training.jsonl").read_text().splitlines()[-1])
            self.assertEqual(line["steps"], 2, "batches of ten in one pass over 20 demonstrations")


class Page(Case):
    def data(self, run):
        page = (self.dir / run / "report.html").read_text()
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])
        self.assert_as_schema("report_data", data)
        return page, data

    def test_pictures_of_the_scenes_that_methods_played(self):
        self.call("run", "q1", "--scenarios", "heart,red_heart", "--methods", "lga,gcbc_dart", "--demos", "10",
                  "--seeds", "0", "--episodes", "5", "--set", "lga.epochs=2", "--set", "gcbc_dart.epochs=1", "--out", "out")
        page, data = self.data("out")
        played, masked, ends = set(), set(), {}
        for key, (cell, _) in self.cells("out").items():
            if cell["method"]["kind"] == "method":
                for line in (self.dir / "out/cells" / key / "episodes.jsonl").read_text().splitlines():
                    episode = json.loads(line)
                    played.add(episode["scene"])
                    masked |= {episode["scene"]} if cell["method"]["id"] == "lga" else set()
                    if episode["action"]:
                        ends[key, episode["index"]] = episode["failure"], episode["scene"]
        self.assertTrue(masked)
        self.assertEqual(set(data["pictures"]), played)
        self.assertEqual({name.split("/")[0] for name in data["masks"]}, masked)
        for bytes_ in [*data["pictures"].values(), *data["masks"].values()]:
            self.assertTrue(base64.b64decode(bytes_).startswith(b"\x89PNG"))
        self.assertEqual(len(set(data["pictures"].values())), len(played), "two scenes look alike")

        # The oracle takes the target, whose outline surrounds where it does.
        for scene in played:
            (x, y), _ = data["oracle"][scene]
            edges = [tuple(map(int, edge)) for edge in re.findall(r"M(\d+) (\d+)", data["targets"][scene])]
            self.assertTrue(min(edges)[0] <= x <= max(edges)[0] + 1, scene)
            self.assertTrue(min(y for _, y in edges) <= y <= max(y for _, y in edges) + 1, scene)
        # The scene after the action: where an object was taken, another one than before.
        shown = {(cell["cell"], int(index)): end for cell in data["cells"] for arm in cell["arms"]
                 for index, end in arm["ends"].items()}
        self.assertEqual(set(shown), set(ends))
        for episode, (failure, scene) in ends.items():
            self.assertEqual(shown[episode] == "", failure == "missed_object", failure)
            self.assertNotEqual(shown[episode], data["pictures"][scene])
        # What the policies saw in these: a picture once for all that saw the same.
        expected = {"lga": (["goal mask, 36 × 72"], []), "gcbc_dart": (["picture, 36 × 72"], ["the command's words"])}
        for cell in data["cells"]:
            method = self.cells("out")[cell["cell"]][0]["method"]["id"]
            for arm in cell["arms"] if method in expected else []:
                for index in map(int, arm["ends"]):
                    saw = data["inputs"][arm["read"][str(index)]]
                    self.assertEqual(([name for name, _ in saw["pictures"]], saw["texts"]), expected[method])
                    width, height = struct.unpack(">II", base64.b64decode(data["seen"][saw["pictures"][0][1]])[16:24])
                    self.assertEqual((width, height), (72, 36))
        self.assertEqual(len(data["seen"]), len(set(data["seen"])))
        self.assertTrue(all(arm["read"] for cell in data["cells"] for arm in cell["arms"]
                            if self.cells("out")[cell["cell"]][0]["method"]["id"] in expected))
        self.call("report", "out")
        self.assertEqual(self.data("out")[0], page)

        # A worker that draws something else than what was played says so ...
        key, (cell, _) = next(iter(self.cells("out").items()))
        request = {"cell": str(self.dir / "out/cells" / key / "cell.json"), "arm": "test", "index": 0, "selections": []}
        drawn = subprocess.run([BUILD / "bin/lgabench-worker", "pictures"], capture_output=True, text=True, check=True,
                               input=json.dumps([dict(request, scene="0" * 16)])).stdout
        self.assertEqual(json.loads(drawn), {"problem": "this version samples another scene than the run played"})

        # ... and one that is missing costs the pictures alone.
        (self.dir / "bin").mkdir()
        shutil.copy(PROGRAM, self.dir / "bin")
        for folder in ("lib", "share"):
            (self.dir / folder).symlink_to(BUILD / folder)
        subprocess.run([self.dir / "bin/lgabench", "report", self.dir / "out"], check=True, capture_output=True,
                       env=dict(self.environment, LD_LIBRARY_PATH=str(BUILD / "lib")))
        page, data = self.data("out")
        self.assertIn("No pictures of scenes: lgabench-worker could not be started: No such file or directory", page)
        self.assertEqual(data["pictures"], {})


    def test_pictures_of_one_space_in_two_environments(self):
        self.call("new-scenario", "apple", "--command", "Bring me an apple.", "--types", "apple", "--space", "household")
        requests = []
        for suite, scenario in (("q1", "apple"), ("mobile", "bring_fruit")):
            self.call("run", suite, "--scenarios", scenario, "--scenario-path", ".", "--answers", "none", "--engines", "kinematic",
                      "--methods", "fixture_constant", "--plugin-path", FIXTURES / "good", "--demos", "2", "--seeds", "0",
                      "--episodes", "1", "--no-reference", "--out", suite)
            (key, _), = self.cells(suite).items()
            cell = self.dir / suite / "cells" / key
            episode = json.loads((cell / "episodes.jsonl").read_text().splitlines()[0])
            requests.append({"cell": str(cell / "cell.json"), "arm": episode["arm"], "index": episode["index"],
                             "scene": episode["scene"], "selections": []})
        drawn = subprocess.run([BUILD / "bin/lgabench-worker", "pictures"], capture_output=True, text=True, check=True,
                               input=json.dumps(requests)).stdout
        for line in map(json.loads, drawn.splitlines()):
            self.assertIsInstance(line.get("oracle"), list, line.get("problem"))


class Engines(Case):
    @unittest.skipUnless((BUILD / "lib/lgabench/plugins/mujoco.so").exists(), "MuJoCo is not built")
    def test_one_policy_on_two_and_where_they_part(self):
        # Pushes that are no oracle's: a block that turns under the blade is where the two differ.
        self.call("run", "q1", "--engines", "mujoco,kinematic", "--scenarios", "sweep_block_without_touching_pan",
                  "--layout", "continuous", "--methods", "lga", "--set", "lga.network=plain", "--demos", "10",
                  "--seeds", "0", "--episodes", "60", "--no-reference", "--out", "run")
        training = {cell["engine"]: (self.dir / "run/cells" / key / "training.jsonl").read_bytes()
                    for key, (cell, _) in self.cells("run").items()}
        self.assertEqual(training["mujoco"], training["kinematic"])
        (agreement,) = json.loads((self.dir / "run/summary.json").read_text())["engine_agreement"]
        row = agreement["rows"][0]
        self.assertEqual((row["method"], row["episodes"], row["other_actions"]), ("lga", 60, 0))
        self.assertEqual(row["episodes"] - row["agreed"], len(agreement["disagreements"]))
        self.assertGreater(row["agreed"], 48)
        self.assertGreater(len(agreement["disagreements"]), 0)
        page = (self.dir / "run/report.html").read_text()
        figures = re.findall(r"<figure class=engines>.*?</figure>", page, re.S)
        self.assertEqual(len(figures), len(agreement["disagreements"]))
        for figure in figures:
            before, *ends = re.findall(r'src="data:image/png;base64,([^"]*)"', figure)
            self.assertEqual(len(set(ends)), 2, "both ends are shown, and differ")
            self.assertNotIn(before, ends)

    @unittest.skipUnless((BUILD / "lib/lgabench/plugins/mujoco.so").exists(), "MuJoCo is not built")
    def test_a_report_shows_what_a_plugins_engine_led_to_where_it_finds_the_plugin(self):
        plugins = self.dir / "plugins"
        plugins.mkdir()
        shipped = (BUILD / "lib/lgabench/plugins/kinematic.so").read_bytes()
        (plugins / "elsewhere.so").write_bytes(shipped.replace(b"kinematic\0", b"elsewhere\0"))
        self.call("run", "q1", "--engines", "mujoco,elsewhere", "--plugin-path", "plugins", "--scenarios",
                  "sweep_block_without_touching_pan", "--layout", "continuous", "--methods", "lga", "--set",
                  "lga.network=plain", "--demos", "10", "--seeds", "0", "--episodes", "60", "--no-reference", "--out", "run")
        for shown in ["before", "elsewhere", "mujoco"], ["before", "mujoco"]:
            page = (self.dir / "run/report.html").read_text()
            figures = re.findall(r"<figure class=engines>.*?</figure>", page, re.S)
            self.assertGreater(len(figures), 0)
            for figure in figures:
                self.assertEqual(re.findall(r"<small>(\w+)", figure), shown)
            self.call("report", "run")  # nobody says where the engine is


class Gallery(Case):
    def test_the_legends_in_the_documentation_are_the_sheets_own(self):
        page = (pathlib.Path(__file__).parents[2] / "docs" / "gallery.md").read_text()
        for what in ("objects", "textures", "scenes", "words", "perturbations", "mobile"):
            printed = self.call("render", "--gallery", what, "--out", "sheet.png").stdout
            file, legend = printed.split("\n\n", 1)
            self.assertEqual(file, "sheet.png")
            self.assertTrue((self.dir / file).read_bytes().startswith(b"\x89PNG"))
            filled = f"<!-- gallery:{what} -->\n\n{legend}\n<!-- /gallery -->\n" in page
            self.assertTrue(filled, f"{what}: docs/tables.py --program LGABENCH --gallery draws the sheets and writes their legends")


if __name__ == "__main__":
    unittest.main(verbosity=2)
