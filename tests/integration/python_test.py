"""Methods in Python, as a person runs them, with LGABENCH_TEST_PYTHON or the first usual interpreter that has NumPy; without
one they are skipped, in CI they fail."""
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading
import unittest

from case import BUILD, Case, command_line, with_options


def has(interpreter, module):
    return subprocess.run([interpreter, "-c", f"import {module}"], capture_output=True).returncode == 0


USUAL = [sys.executable] + [path for path in ("/usr/bin/python3",) if os.access(path, os.X_OK)]
PYTHON = os.environ.get("LGABENCH_TEST_PYTHON") or next((path for path in USUAL if has(path, "numpy")), sys.executable)
EXAMPLES = pathlib.Path(__file__).parents[2] / "examples/python"
HAS_NUMPY = has(PYTHON, "numpy") or os.environ.get("CI") == "true"
ALONE = '''
import pathlib
from lgabench_method import select_features

class Alone:
    version = "1"
    summary = "selects, and throws whatever else it is asked"

    def needs(self, options):
        raise ValueError("asked for its needs")

    def select(self, command, space, services):
        (pathlib.Path(services.files) / "asked").write_text(command.utterance)
        return select_features(command, space, services.lm)

    def learn(self, demonstrations, services):
        raise ValueError("asked to learn")
'''
RUN = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "3", "--no-reference",
       "--python", PYTHON]
SERVER = '''
import msgpack
from websockets.sync.server import serve

def handle(socket):
    for message in socket:
        asked = msgpack.unpackb(message)
        assert len(asked["image"]) == asked["shape"][0] * asked["shape"][1] * 3 and asked["prompt"] == "Bring me the heart."
        socket.send(msgpack.packb({"actions": [[number["high"] for number in asked["actions"]]]}))

with serve(handle, "127.0.0.1", 0, max_size=None) as server:
    print(server.socket.getsockname()[1], flush=True)
    server.serve_forever()
'''
METHOD = '''
import getpass
import os
import socket
import tempfile
import numpy
import helper
from lgabench_method import Needs, Refused, SecondSet, Selection, select_features

class Mine:
    version = "0.3"
    summary = "a test's"
    options = {"how": {"default": "", "help": "what it does", "source": "test"}}

    def needs(self, options):
        return Needs(targets="selected")

    def select(self, command, space, services):
        how = services.options["how"]
        if how == "raise":
            raise ValueError("its own failure")
        if how == "no_utf8":
            raise ValueError(os.fsdecode(b"\\xff") + " is no picture")
        if how == "log":
            services.log.epoch(1, 1, 0.5)
        if how.startswith("connect:"):
            socket.create_connection(("localhost", int(how[8:])), 10).close()
        if how == "human":
            services.human.specify(command)
        if how == "no_selection":
            services.human.edit(command, "all")
        if how == "second_target":
            return Selection(second=SecondSet(["heart"], ["red"], "target"))
        if how == "rule":
            selection = Selection()
            selection.target.object_types, selection.target.textures = ["heart"], list(space.textures)
            return selection
        if how == "user":
            user = getpass.getuser()
            for directory in os.path.expanduser("~"), tempfile.gettempdir(), os.environ["TORCHINDUCTOR_CACHE_DIR"]:
                os.makedirs(os.path.join(directory, user), exist_ok=True)
        if how == "read":
            open(os.environ["LGABENCH_DATA"] + "/scenarios/heart.json")
        selection = select_features(command, space, services.lm)
        if how == "edit":
            selection.target.object_types.append("star")
        return selection

    def learn(self, demonstrations, services):
        assert demonstrations[0].steps[0].observation.rgb.shape == (128, 256, 3)
        assert not demonstrations[0].steps[0].observation.rgb.flags.writeable
        if services.options["how"] == "rewrite":
            open(os.path.join(os.path.dirname(__file__), "helper.py"), "a").write("# more")
        services.log.epoch(1, 10, float("nan") if services.options["how"] == "nan_loss" else 0.5, validation=0.25)
        if services.options["how"] == "curve_name":
            services.log.epoch(2, 10, 0.5, epoch=1)
        open(os.path.join(services.files, "curve.csv"), "w").write("1")
        if services.options["how"] == "exit":
            os._exit(5)
        if services.options["how"] == "sys_exit":
            raise SystemExit(0)
        if services.options["how"] == "close":
            os.close(3)
        return Policy(services.options["how"], demonstrations[0].steps[0].label)

class Policy:
    def __init__(self, how, label):
        self.how, self.label = how, label

    def act(self, observation, instruction):
        if self.how == "nan":
            return [float("nan")] * 12
        if self.how == "short":
            return [0.5]
        if self.how == "huge":
            return [1e300] + list(self.label[1:])
        return self.label
'''


LATE = '''
import numpy
from lgabench_method import FeatureSet, Selection, Shown, goal_mask

class Late:
    def select(self, command, space, services):
        return Selection(FeatureSet(["heart"], list(space.textures)))

    def revise(self, command, selected, demonstrations, services):
        assert len(demonstrations) == 10 and selected.provenance == "rule"
        return Selection(FeatureSet(selected.target.object_types, ["red"]))

    def learn(self, demonstrations, services):
        assert demonstrations[0].instruction.selection.target.textures == ["red"]
        return Policy(demonstrations[0].steps[0].label)

class Policy:
    def __init__(self, label):
        self.label = label

    def act(self, observation, instruction):
        self.mask = goal_mask(observation, instruction.selection)
        return self.label

    def shown(self):
        return Shown([("goal mask", self.mask), ("picture", numpy.zeros((2, 3, 3)), "darkened")], ["nothing"])
'''


@unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
class PythonMethods(Case):
    def setUp(self):
        super().setUp()
        (self.dir / "mine.py").write_text(METHOD)
        (self.dir / "helper.py").write_text("x = 1\n")

    def test_an_interpreter_without_numpy_or_that_is_gone_is_told_from_others(self):
        subprocess.run([PYTHON, "-m", "venv", "--without-pip", self.dir / "bare"], check=True)
        said = self.call(*with_options(RUN, "--python", "bare/bin/python"), "--methods", "mine.py:Mine", expect=4).stderr
        self.assertIn("bare/bin/python: has no NumPy, which plugins in Python need: bare/bin/python -m pip install numpy, or name", said)
        (self.dir / "moved").symlink_to("/nowhere/python3")
        said = self.call(*with_options(RUN, "--python", "./moved"), "--methods", "mine.py:Mine", expect=4).stderr
        self.assertIn("./moved: a link to /nowhere/python3, which does not exist: make the virtual environment again", said)

    def how(self, *words, expect=0):
        methods = ",".join("mine.py:Mine" + (f"+how={word}" if word else "") for word in words)
        done = self.call(*RUN, "--methods", methods, "--out", "out", expect=expect)
        found = {}
        for key, (cell, status) in self.cells("out").items():
            found[cell["method"]["options"]["how"]] = self.dir / "out/cells" / key, status
        return found, done

    def test_a_row_beside_a_plugins(self):
        self.call(*RUN, "--methods", "lga,mine.py:Mine", "--set", "lga.epochs=5", "--out", "out")
        self.assert_matches_schemas("out")
        own = {cell["method"]["id"]: (key, cell, status) for key, (cell, status) in self.cells("out").items()}
        key, cell, status = own["mine"]
        build = json.loads(status["build"]["python"])
        self.assertIn("numpy", build)
        self.assertIn("python", build)
        self.assertEqual(len(build["helper.py"]), 64)
        selection = json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"][0]["selection"]
        other = json.loads((self.dir / "out/cells" / own["lga"][0] / "selection.json").read_text())["commands"][0]
        self.assertEqual(selection, other["selection"])
        self.assertEqual((self.dir / "out/cells" / key / "files/curve.csv").read_text(), "1")
        logged = (self.dir / "out/cells" / key / "training.jsonl").read_text()
        self.assertEqual(json.loads(logged), {"epoch": 1, "steps": 10, "loss": .5, "validation": .25})
        for curve in ("loss", "validation"):
            self.assertTrue((self.dir / "out/figures" / f"training_{curve}_continuous_{cell['engine']}.svg").exists())
        again = self.call(*RUN, "--methods", "lga,mine.py:Mine", "--set", "lga.epochs=5", "--out", "again")
        self.assert_same_results("out", "again")
        self.call("verify", "out", "--all", "--methods", "mine.py:Mine", "--python", PYTHON)
        # An option that the method has no more is what it was to the recorded cells.
        (self.dir / "mine.py").write_text(METHOD.replace('options = {"how":', 'options = {"what":'))
        said = self.call("verify", "out", "--all", "--methods", "mine.py:Mine", "--python", PYTHON)
        self.assertIn("build: method mine", said.stdout)
        (self.dir / "mine.py").write_text(METHOD)
        (self.dir / "helper.py").write_text("x = 2\n")
        said = self.call(*RUN, "--methods", "lga,mine.py:Mine", "--set", "lga.epochs=5", "--out", "out", expect=2)
        self.assertIn("python differs", said.stderr)

    def test_its_options_are_its_own_whatever_they_are_called(self):
        """q1 sets a network and a loss for all methods that train the framework's."""
        own = METHOD.replace('options = {', 'options = {"loss": {"default": "huber", "values": ["huber"], "help": "", '
                             '"source": "test"}, "network": {"default": 5, "help": "layers", "source": "test"}, ')
        (self.dir / "mine.py").write_text(own)
        self.call(*RUN, "--methods", "mine.py:Mine", "--out", "out")
        (cell, _), = self.cells("out").values()
        self.assertEqual(cell["method"]["options"], {"how": "", "loss": "huber", "network": 5})
        (self.dir / "mine.py").write_text(own.replace('"source"', '"framework": True, "source"', 1))
        self.assertIn('options: /loss: unknown member "framework"',
                      self.call(*RUN, "--methods", "mine.py:Mine", "--out", "other", expect=4).stderr)

    def test_a_package_beside_the_file_is_part_of_the_build(self):
        (self.dir / "pack").mkdir()
        (self.dir / "pack/__init__.py").write_text("from pack.inner import x\n")
        (self.dir / "pack/inner.py").write_text("x = 1\n")
        (self.dir / "pack/unused.py").write_text("no Python\n")
        (self.dir / "mine.py").write_text(METHOD.replace("import helper", "import pack"))
        run = [*RUN, "--methods", "mine.py:Mine", "--out", "out"]
        self.call(*run)
        (_, status), = self.cells("out").values()
        self.assertLessEqual({"pack/__init__.py", "pack/inner.py"}, set(json.loads(status["build"]["python"])))
        (self.dir / "pack/inner.py").write_text("x = 2\n")
        self.assertIn("python differs", self.call(*run, expect=2).stderr)

    def test_modules_beside_a_link_to_the_file_are_those_that_it_imports(self):
        (self.dir / "link").mkdir()
        (self.dir / "link/mine.py").symlink_to("../mine.py")
        self.call(*RUN, "--methods", "link/mine.py:Mine", "--out", "out")
        (_, status), = self.cells("out").values()
        self.assertIn("helper.py", json.loads(status["build"]["python"]))

    def test_packages_that_the_user_has_installed(self):
        self.environment["PYTHONUSERBASE"] = str(self.dir / "user")
        where = "import numpy, site; print(site.getusersitepackages() if site.ENABLE_USER_SITE else '')"
        found = subprocess.run([PYTHON, "-c", where], env=self.environment, capture_output=True, text=True).stdout.strip()
        if not found:
            self.skipTest(f"{PYTHON} looks for none, or has NumPy there")
        (self.dir / "code").mkdir()
        pathlib.Path(found).mkdir(parents=True)
        pathlib.Path(found, "of_the_user.py").write_text("x = 1\n")
        (self.dir / "code/mine.py").write_text(METHOD.replace("import helper", "import of_the_user"))
        self.call(*RUN, "--methods", "code/mine.py:Mine", "--out", "out")

    def test_bytecode_beside_the_file_is_not_run(self):
        (self.dir / "pack").mkdir()
        files = [self.dir / name for name in ("mine.py", "helper.py", "pack/__init__.py", "pack/inner.py")]
        for file in files:
            file.write_text("raise ValueError('not what the file says')\n")
        subprocess.run([PYTHON, "-m", "compileall", "-q", "--invalidation-mode", "unchecked-hash", self.dir], check=True)
        files[0].write_text(METHOD.replace("import helper", "import helper\nimport pack.inner"))
        for file in files[1:]:
            file.write_text("x = 1\n")
        self.call(*RUN, "--methods", "mine.py:Mine", "--out", "out")

    def test_a_module_that_changes_in_the_middle_of_a_run_is_refused(self):
        self.call(*with_options(RUN, "--seeds", "0:2"), "--unconfined", "--jobs", "1", "--methods",
                  "mine.py:Mine+how=rewrite", "--out", "out", expect=4)
        states = {status["state"]: status for _, status in self.cells("out").values()}
        self.assertEqual(set(states), {"ok", "failed"})
        self.assertIn("helper.py: changed since the run began", states["failed"]["reason"])

    def test_runs_of_other_modules_are_not_merged(self):
        for seed in ("0", "1"):
            (self.dir / "helper.py").write_text(f"x = {seed}\n")
            self.call(*with_options(RUN, "--seeds", seed), "--methods", "mine.py:Mine", "--out", "of" + seed)
        said = self.call("merge", "both", "of0", "of1", expect=2).stderr
        self.assertRegex(said, r"of[01]/cells/\w+ and of[01]/cells/\w+: different builds of method mine: their interpreter, ")
        self.assertFalse((self.dir / "both").exists())
        self.call("merge", "one", "of0")

    def test_loading_is_a_phase_of_its_own(self):
        (self.dir / "mine.py").write_text("import time\ntime.sleep(2)\n" + METHOD.replace(
            "class Mine:\n", "class Mine:\n    def __init__(self):\n        time.sleep(2)\n\n"))
        (cell, _), = self.how("")[0].values()
        timing = json.loads((cell / "timing.json").read_text())
        self.assertGreater(timing["load_s"], 4)
        self.assertLess(timing["select_s"], 2)
        self.assert_matches_schemas("out")
        shown = next(line for line in (self.dir / "out/report.md").read_text().splitlines() if "| select | sample |" in line)
        self.assertIn("| load | select |", shown)

    def test_who_says_where_a_selection_comes_from(self):
        found, _ = self.how("", "rule", "edit")
        provenance = {}
        for how, (cell, _) in found.items():
            selection = json.loads((cell / "selection.json").read_text())["commands"][0]["selection"]
            provenance[how] = selection["provenance"], selection["source"].endswith(", edited by the method")
        self.assertEqual(provenance, {"": ("recorded", False), "rule": ("rule", False), "edit": ("recorded", True)})

    def test_a_selection_is_revised_and_what_is_read_is_shown(self):
        (self.dir / "late.py").write_text(LATE)
        self.call(*RUN, "--methods", "late.py:Late,mine.py:Mine", "--out", "out")
        self.assert_matches_schemas("out")
        cells = {cell["method"]["id"]: self.dir / "out/cells" / key for key, (cell, _) in self.cells("out").items()}
        command, = json.loads((cells["late"] / "selection.json").read_text())["commands"]
        self.assertEqual(command["selection"]["target"], {"object_types": ["heart"], "textures": ["red"]})
        self.assertEqual(command["selection"]["provenance"], "rule")
        self.assertGreater(len(command["before_revision"]["target"]["textures"]), 1)
        self.assertEqual(command["quality"]["target"]["textures"]["size"], 1)
        scenes = json.loads((cells["late"] / "shown.json").read_text())["scenes"]
        self.assertEqual([scene["index"] for scene in scenes], [0, 1, 2])
        self.assertEqual([picture["caption"] for picture in scenes[0]["pictures"]],
                         ["goal mask, 128 × 256", "picture, 2 × 3; darkened"])
        self.assertEqual((scenes[0]["texts"], scenes[0]["unread"]), (["nothing"], []))
        # On the page, for whoever's method it is; one of 0.2, which tells nothing, has its row without.
        self.assertFalse((cells["mine"] / "shown.json").exists())
        page = (self.dir / "out/report.html").read_text()
        self.assertIn("goal mask, 128 × 256", page)
        self.assertIn("picture, 2 × 3; darkened", page)
        # What cannot be shown costs the pictures alone.
        (self.dir / "late.py").write_text(LATE.replace("zeros((2, 3, 3))", "zeros((2, 3, 4))"))
        self.call(*RUN, "--methods", "late.py:Late", "--out", "without")
        (key, (_, status)), = self.cells("without").items()
        self.assertEqual(status["state"], "ok")
        self.assertFalse((self.dir / "without/cells" / key / "shown.json").exists())
        self.assertIn("expected rows x columns", (self.dir / "without/cells" / key / "log.txt").read_text())
        self.assertEqual((self.dir / "without/cells" / key / "episodes.jsonl").read_bytes(),
                         (cells["late"] / "episodes.jsonl").read_bytes())

    def test_what_selects_alone_is_asked_for_nothing_else(self):
        (self.dir / "alone.py").write_text(ALONE)
        rows = "lga,selected_by:lga,selected_by:alone.py:Alone,selected_by:late.py:Late"
        (self.dir / "late.py").write_text(LATE.replace("== 10", "== 2"))
        self.call(*with_options(RUN, "--demos", "2"), "--methods", rows, "--set", "*.policy=heat_map", "--out", "out")
        self.assert_matches_schemas("out")
        cells = {cell["method"]["name"]: (self.dir / "out/cells" / key, cell, status)
                 for key, (cell, status) in self.cells("out").items()}
        self.assertEqual(sorted(cells), ["lga", "selected_by:alone", "selected_by:late", "selected_by:lga"])
        directory, cell, status = cells["selected_by:alone"]
        self.assertEqual(cell["method"]["acts"]["options"]["policy"], "heat_map")
        self.assertEqual(len(status["build"]["acts"]), 64)
        for row in "selected_by:alone", "selected_by:lga":
            for name in "selection.json", "training.jsonl", "episodes.jsonl":
                self.assertEqual((cells[row][0] / name).read_bytes(), (cells["lga"][0] / name).read_bytes(), (row, name))
        self.assertEqual((directory / "files/asked").read_text(), "Bring me the heart.")
        command, = json.loads((cells["selected_by:late"][0] / "selection.json").read_text())["commands"]
        self.assertEqual(command["selection"]["target"]["textures"], ["red"], "it is asked to revise")
        self.assertIn("selected by LGA", (self.dir / "out/report.html").read_text())
        self.call("verify", "out", "--all", "--methods", "selected_by:alone.py:Alone,late.py:Late", "--python", PYTHON)

    def test_a_user_and_places_to_write(self):
        """As PyTorch's compiler wants them when an optimiser is imported; the system's list of users cannot be read."""
        self.how("user")

    def test_naming_a_method_runs_nothing_that_lies_beside_it(self):
        planted = ("import os\ntry:\n    with open({!r} + __name__, 'w') as file:\n        file.write(str(dict(os.environ)))\n"
                   "except OSError:\n    pass  # confined, as where the method runs\n").format(f"{self.dir}/ran_")
        for name in "ast", "json", "hashlib", "inspect", "site", "sitecustomize", "usercustomize", "lgabench_method":
            (self.dir / f"{name}.py").write_text(planted)
        (self.dir / "path").mkdir()
        (self.dir / "path/sitecustomize.py").write_text(planted)
        self.environment.update(PYTHONPATH=str(self.dir / "path"), PYTHONSTARTUP=str(self.dir / "ast.py"))
        for words in (("check-plugin", "mine.py:Mine", "--python", PYTHON), ("info", "q1"),
                      (*RUN, "--methods", "mine.py:Mine", "--dry-run"), (*RUN, "--methods", "mine.py:Mine", "--out", "out")):
            self.call(*words)
            self.assertEqual([path.name for path in self.dir.glob("ran_*")], [], words)

    def test_describing_sees_no_secret_and_any_way_to_name_the_interpreter(self):
        """By an interpreter that writes its environment down before it is Python."""
        (self.dir / "bin").mkdir()
        teller = self.dir / "bin/teller"
        teller.write_text(f'#!/bin/sh\nenv > "{self.dir}/told"\npwd >> "{self.dir}/told"\nexec {PYTHON} "$@"\n')
        teller.chmod(0o755)
        self.environment.update(OPENAI_API_KEY="sk-secret", GITHUB_TOKEN="ghp-secret",
                                PATH=f"{self.dir}/bin:{self.environment['PATH']}")
        for name in "teller", "bin/teller", str(teller):
            self.call(*with_options(RUN, "--python", name), "--methods", "mine.py:Mine", "--dry-run")
            told = (self.dir / "told").read_text()
            self.assertNotIn("secret", told)
            self.assertIn(f"HOME={os.environ['HOME']}\n", told)
            self.assertNotIn(f"\n{self.dir}\n", told)
            (self.dir / "told").unlink()

    def test_describing_reads_nothing_else(self):
        """What runs when the interpreter starts writes a file where it was not told of the method, and nowhere else."""
        subprocess.run([PYTHON, "-m", "venv", "--system-site-packages", "--without-pip", self.dir / "venv"], check=True)
        packages = next((self.dir / "venv/lib").glob("python3*")) / "site-packages"
        (packages / "of_the_venv.py").write_text(f"try:\n    import sys\n    with open('{self.dir}/told', 'a') as file:\n"
                                                 "        file.write(sys.orig_argv[-1] + ' ')\nexcept OSError:\n    pass\n")
        (packages / "start.pth").write_text("import of_the_venv\n")
        self.call(*with_options(RUN, "--python", "venv/bin/python"), "--methods", "mine.py:Mine", "--dry-run")
        self.assertEqual((self.dir / "told").read_text(), "--interpreter ")

    def described(self, name, *more):
        """What naming it says, and the most memory in GiB that one of the processes had."""
        with subprocess.Popen(command_line(*with_options(RUN, "--methods", name, *more), "--dry-run"), stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=self.environment,
                              cwd=self.dir, start_new_session=True) as process:
            stop = threading.Timer(60, os.killpg, (process.pid, signal.SIGKILL))
            stop.start()
            said = process.stderr.read()
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            stop.cancel()
        self.assertEqual(process.returncode, 4, said)
        return said, used.ru_maxrss / (1 << 20)

    def test_describing_takes_limited_time_and_memory(self):
        (self.dir / "big.py").write_text("x=[" + "0," * ((4 << 20) - 100) + "]\nclass M: pass\n")
        said, most = self.described("big.py:M")
        self.assertIn("big.py: reading it took more than 10 s of processor time or 2 GiB of memory", said)
        self.assertEqual(said.count("\n"), 1, said)
        self.assertLess(most, 2.2)
        # An interpreter that is never done with the file.
        subprocess.run([PYTHON, "-m", "venv", "--system-site-packages", "--without-pip", self.dir / "venv"], check=True)
        packages = next((self.dir / "venv/lib").glob("python3*")) / "site-packages"
        (packages / "slow.py").write_text("import sys\nwhile sys.orig_argv[-1] != '--interpreter':\n    pass\n")
        (packages / "start.pth").write_text("import slow\n")
        self.assertIn("reading it took more than 10 s", self.described("mine.py:Mine", "--python", "venv/bin/python")[0])

    def test_what_is_no_file_or_too_large_is_not_opened(self):
        os.mkfifo(self.dir / "fifo.py")
        (self.dir / "link.py").symlink_to("/dev/zero")
        (self.dir / "folder.py").mkdir()
        with (self.dir / "large.py").open("w") as file:
            file.truncate((8 << 20) + 1)
        for name in "fifo.py", "link.py", "folder.py", "large.py":
            for written in name, name + ":M":
                said, _ = self.described(written)
                self.assertRegex(said, f"{name}: expected (a regular file|at most 8 MiB, got 8388609 bytes)\n$")
        self.assertIn("nothing.py: cannot be read: No such file", self.described("nothing.py:M")[0])
        (self.dir / "pack").mkdir()  # which the method imports
        os.mkfifo(self.dir / "pack/fifo.py")
        (self.dir / "mine.py").write_text(METHOD.replace("import helper", "import pack"))
        self.call(*RUN, "--methods", "mine.py:Mine", "--dry-run", timeout=60)

    def test_a_virtual_environment_named_from_here(self):
        subprocess.run([PYTHON, "-m", "venv", "--system-site-packages", "--without-pip", self.dir / "venv"], check=True)
        packages = next((self.dir / "venv/lib").glob("python3*")) / "site-packages"
        (packages / "of_the_venv.py").write_text("x = 1\n")
        (self.dir / "mine.py").write_text(METHOD.replace("import helper", "import of_the_venv"))
        self.call(*with_options(RUN, "--python", "venv/bin/python"), "--methods", "mine.py:Mine", "--out", "out")

    def test_what_fails_costs_its_own_cell(self):
        reasons = {"raise": "plugin mine: ValueError: its own failure (mine.py:", "human": "plugin mine: ",
                   "no_utf8": "ValueError: ? is no picture", "log": "services.log.epoch() was called outside of learn()",
                   "exit": "exited with 5 in phase learn",
                   "sys_exit": "ended its own process by sys.exit() (mine.py:", "close": "closed descriptor 3, or put another file there", "nan_loss": "training diverged",
                   "no_selection": "edit() was given str",
                   "second_target": "the second set has the role \"target\"",
                   "curve_name": "a curve's name", "read": "PermissionError"}
        found, done = self.how("", "nan", "short", "huge", *reasons, expect=3)
        self.assertNotIn("no report", done.stderr)
        for how in ("nan", "short", "huge"):
            episodes = [json.loads(line) for line in (found[how][0] / "episodes.jsonl").read_text().splitlines()]
            self.assertEqual({e["failure"] for e in episodes}, {"method_error"}, how)
        for how, reason in reasons.items():
            cell, status = found[how]
            self.assertEqual((status["state"], status["fault"]), ("failed", "plugin"), how)
            self.assertIn(reason, status["reason"], how)
        self.assertIn("Traceback", (found["raise"][0] / "log.txt").read_text())

    def test_the_network_for_a_method_that_declares_it(self):
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        how = f"how=connect:{server.getsockname()[1]}"
        (self.dir / "net.py").write_text(METHOD.replace('version = "0.3"', 'version = "0.3"\n    asks = "network"'))
        done = self.call(*RUN, "--methods", f"mine.py:Mine+{how},net.py:Mine+{how}", "--out", "out", expect=3)
        states = {cell["method"]["id"]: status for cell, status in self.cells("out").values()}
        self.assertRegex(states["mine"]["reason"], "gaierror|PermissionError")
        self.assertEqual(states["net"]["state"], "ok")
        self.assertIn("¶ reached the network on its own", done.stdout)
        self.call("check-plugin", "net.py:Mine", "--python", PYTHON, "--set", how)

    def test_refused_with_a_reason(self):
        for word, said in {"mine.py:Other": "no class Other, it has: Mine, Policy", "none.py:A": "No such file", "none.py": "none.py: no such file",
                           "bad.py:A": "bad.py", "named.py:A": "id \"Upper\"", "options.py:A": "options",
                           "sets.py:A": "sets.py: options: expected values that JSON has",
                           "endless.py:A": "endless.py: options: expected values that JSON has",
                           "asks.py:A": "asks.py: questionnaire: expected True or False",
                           "computed.py:A": "computed.py: options: expected a literal, which can be read without running the file"}.items():
            (self.dir / "computed.py").write_text("class A:\n    options = dict(x={'default': 1, 'help': '', 'source': ''})\n")
            (self.dir / "asks.py").write_text("class A:\n    questionnaire = 'yes'\n")
            (self.dir / "bad.py").write_text("class A(")
            (self.dir / "named.py").write_text("class A:\n    id = 'Upper'\n")
            (self.dir / "options.py").write_text("class A:\n    options = {'x': {'default': [1]}}\n")
            (self.dir / "sets.py").write_text("class A:\n    options = {'x': {'default': 'a', 'values': {'a', 'b'}}}\n")
            (self.dir / "endless.py").write_text("class A:\n    options = {'x': {'default': 1e999}}\n")
            self.assertIn(said, self.call(*RUN, "--methods", word, "--out", "out", expect=4).stderr)
        (self.dir / "bounds.py").write_text(
            "class A:\n    options = {'p': {'default': .5, 'min': 0, 'max': 1, 'help': '', 'source': ''}}\n")
        said = self.call(*RUN, "--methods", "bounds.py:A+p=2", "--out", "out", expect=2).stderr
        self.assertIn("/p: expected a number from 0 to 1, got 2", said)
        (self.dir / "old.py").write_text("import sys\nfrom lgabench_method import describe\nsys.version_info = (3, 9, 2)\n"
                                         "try:\n    describe.interpreter()\n"
                                         "except describe.NoMethod as error:\n    print(error)\n")
        done = subprocess.run([PYTHON, self.dir / "old.py"], capture_output=True, text=True, cwd=self.dir,
                              env=dict(os.environ, PYTHONPATH=f"{BUILD}/share/lgabench/python"))
        self.assertEqual(done.stdout, "Python 3.9, expected 3.10 or later\n", done.stderr)

    def test_committed_embeddings_can_be_read(self):
        (self.dir / "near.py").write_text("""
from lgabench_method import FeatureSet, Selection
from lgabench_method.embeddings import embedding

class Near:
    version, summary = "1", "the type whose name is nearest to the command"

    def select(self, command, space, services):
        words = embedding(command.utterance)
        nearest = max(space.object_types, key=lambda name: embedding(name) @ words)
        return Selection(FeatureSet([nearest], list(space.textures)))

    def learn(self, demonstrations, services):
        label = demonstrations[0].steps[0].label
        return type("Same", (), {"act": lambda self, observation, instruction: label})()
""")
        self.call(*RUN, "--methods", "near.py:Near", "--out", "near")
        selections = [json.loads(file.read_text()) for file in (self.dir / "near/cells").glob("*/selection.json")]
        self.assertEqual([one["commands"][0]["selection"]["target"]["object_types"] for one in selections], [["heart"]])

    def test_new_plugin_and_check_plugin(self):
        self.call("new-plugin", "my_method", "--kind", "python")
        done = self.call("check-plugin", "my_method/my_method.py:MyMethod", "--python", PYTHON)
        self.assertIn("good", done.stdout)
        self.call(*RUN, "--methods", "my_method/my_method.py:MyMethod", "--out", "out")


# learning/inputs.hpp's words: row r touches native rows floor(128 r / 36) to ceil(128 (r + 1) / 36) - 1, columns alike.
SHRUNK = '''
import math, numpy
from lga_torch import small_mask
from lgabench_method import FeatureSet, Instance, Instruction, Observation, Selection

def touched(i, native, small):
    return slice(math.floor(native * i / small), math.ceil(native * (i + 1) / small))

ids = numpy.random.default_rng(0).choice([0, 1, 2], size=(128, 256), p=[.8, .05, .15]).astype(numpy.uint8)
instances = [Instance(1, "heart", "red", 1), Instance(2, "star", "red", 1)]
mask = small_mask(Observation(None, ids, instances), Instruction("", Selection(FeatureSet(["heart"], ["red"]))))
expected = [[(ids[touched(r, 128, 36), touched(c, 256, 72)] == 1).any() for c in range(72)] for r in range(36)]
assert mask.shape == (1, 36, 72) and 0 < mask.mean() < 1
print("same" if (mask[0] == numpy.array(expected)).all() else "different")
'''


class PythonExamples(Case):
    """examples/python, confined as any method; each where the interpreter has what it imports."""

    def need(self, module):
        if not has(PYTHON, module):
            self.skipTest(f"{PYTHON} has no {module}")

    def beside(self, other, example, *more):
        """The rows of the run, by method, and the directory of each method's cell."""
        self.call(*with_options(RUN, "--methods", f"{other},{EXAMPLES / example}", "--out", "out", *more))
        self.assert_matches_schemas("out")
        rows = {row["method"].partition("+")[0]: row for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]}
        cells = {cell["method"]["id"]: self.dir / "out/cells" / key for key, (cell, _) in self.cells("out").items()}
        return rows, cells

    def test_lga_in_pytorch(self):
        self.need("torch")
        short = ("--set", "*.epochs=60", "--demos", "20", "--episodes", "10", "--layout", "cells")
        rows, cells = self.beside("lga+network=plain", "lga_torch.py:Lga", *short)
        own, other = (json.loads((cells[name] / "selection.json").read_text()) for name in ("lga_torch", "lga"))
        self.assertEqual(own, other)
        seen, as_seen = ([json.loads(line)["input_seen"] for line in (cells[name] / "episodes.jsonl").read_text().splitlines()]
                         for name in ("lga_torch", "lga"))
        self.assertEqual(seen, as_seen)
        self.assertIn(True, seen)
        losses = [[json.loads(line) for line in (cells[name] / "training.jsonl").read_text().splitlines()]
                  for name in ("lga_torch", "lga")]
        self.assertEqual(*([(line["epoch"], line["steps"]) for line in one] for one in losses))
        self.assertLess(abs(losses[0][-1]["loss"] - losses[1][-1]["loss"]), .1 * losses[1][0]["loss"])
        self.assertNotIn("method_error", rows["lga_torch"]["failures"])
        self.call(*with_options(RUN, "--methods", f"{EXAMPLES}/lga_torch.py:Lga", "--out", "again", *short))
        again, = self.cells("again")
        self.assertEqual((self.dir / "again/cells" / again / "episodes.jsonl").read_bytes(),
                         (cells["lga_torch"] / "episodes.jsonl").read_bytes())

    def test_the_mask_is_that_of_shrink_mask(self):
        self.need("torch")
        done = subprocess.run([PYTHON, "-c", SHRUNK], capture_output=True, text=True, timeout=100,
                              env=dict(os.environ, PYTHONPATH=f"{EXAMPLES}:{BUILD}/share/lgabench/python"))
        self.assertEqual((done.returncode, done.stdout), (0, "same\n"), done.stderr)

    def test_each_in_the_other_environment(self):
        for module, example in ("torch", "lga_torch.py:Lga"), ("sklearn", "forest_sklearn.py:Forest"):
            with self.subTest(example):
                self.need(module)
                self.call("run", "mobile", "--scenarios", "bring_fruit", "--engines", "kinematic", "--methods",
                          EXAMPLES / example, "--demos", "2", "--seeds", "0", "--episodes", "1", "--no-reference",
                          "--python", PYTHON, *(("--set", "*.epochs=2") if module == "torch" else ()), "--out", module)
                for row in json.loads((self.dir / module / "summary.json").read_text())["rows"]:
                    self.assertNotIn("method_error", row["failures"])

    def test_behaviour_cloning_with_a_spatial_softmax(self):
        self.need("torch")
        rows, _ = self.beside(f"{EXAMPLES}/bc_torch.py:Bc", "bc_torch.py:Bc+input=rgb", "--set", "*.epochs=40", "--demos",
                              "50", "--episodes", "10", "--layout", "cells")
        self.assertNotIn("method_error", rows["bc_torch"]["failures"])
        success = [row["success"] for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]]
        self.assertGreaterEqual(max(success), .7, "on masks")

    def test_a_policy_server(self):
        self.need("websockets")
        self.need("msgpack")
        server = subprocess.Popen([PYTHON, "-c", SERVER], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(server.communicate)
        self.addCleanup(server.kill)
        address = f"ws://127.0.0.1:{server.stdout.readline().strip()}"
        (self.dir / "policy_server.py").write_text((EXAMPLES / "policy_server.py").read_text())
        self.call("run", "q1", "--scenarios", "heart", "--methods", f"policy_server.py:Served+address={address}", "--answers", "none",
                  "--demos", "1", "--seeds", "0", "--episodes", "2", "--no-reference", "--python", PYTHON, "--out", "out")
        acted = [json.loads(line)["action"] for file in self.dir.glob("out/cells/*/episodes.jsonl") for line in file.read_text().splitlines()]
        self.assertEqual(acted, 2 * [[.75, .5, 1, 1, 1, 1] * 2])

    def test_a_plan_that_is_kept(self):
        self.call("run", "errands", "--preset", "smoke", "--scenarios", "errands_fruit", "--episodes", "16", "--methods",
                  EXAMPLES / "plan.py:Plan", "--no-reference", "--python", PYTHON, "--out", "out")
        shares = {row["arm"]: row["paired"]["share"] for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]
                  if row["scenario"] == "errands_fruit"}
        self.assertEqual(shares["told"], 1)
        self.assertLess(shares["appears"], 1, "it does not look again")

    def test_joblib_falls_back_on_one_process(self):
        self.need("joblib")
        (self.dir / "mine.py").write_text(LATE.replace("import numpy\n", "import joblib, numpy\n", 1).replace(
            "        return Policy(demonstrations[0]", "        print(joblib.Parallel(n_jobs=2)(joblib.delayed(abs)(i) for i in (-3, -4)))\n"
            "        return Policy(demonstrations[0]", 1))
        self.call(*with_options(RUN, "--methods", "mine.py:Late", "--out", "out"))
        log, = [path.read_text() for path in (self.dir / "out").glob("cells/*/log.txt")]
        self.assertIn("[3, 4]", log)

    def test_a_forest_in_scikit_learn(self):
        self.need("sklearn")
        rows, _ = self.beside("lga", "forest_sklearn.py:Forest", "--set", "lga.epochs=1", "--demos", "50", "--episodes",
                              "10", "--layout", "cells")
        self.assertNotIn("method_error", rows["forest_sklearn"]["failures"])
        self.assertGreaterEqual(rows["forest_sklearn"]["success"], .8)


if __name__ == "__main__":
    unittest.main(verbosity=2)
