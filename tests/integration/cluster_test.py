"""`lgabench cluster` and `lgabench status`: scripts for Slurm, and how far the parts are; GNU parallel over ssh.

Elements are played by bash here; in ./test --full on a real Slurm of this machine and over a real ssh, where they are installed.
By hand: python3 cluster_test.py Elements
"""
import fcntl
import getpass
import json
import os
import pathlib
import re
import shlex
import shutil
import socket
import subprocess
import textwrap
import time
import unittest

from case import FIXTURES, PROGRAM, Case, with_options

RUN = ("q1", "--scenarios", "heart,letter", "--methods", "fixture_constant", "--plugin-path", FIXTURES / "good",
       "--demos", "2,4", "--seeds", "0:2", "--episodes", "2", "--engines", "kinematic")
PAGE = pathlib.Path(__file__).parents[2] / "docs/running-on-a-cluster.md"
SSHD = shutil.which("sshd", path=os.environ["PATH"] + ":/usr/sbin")
SLURM = all(map(shutil.which, ("slurmctld", "slurmd", "sbatch", "sacct", "scontrol")))


class Elements(Case):
    def cluster(self, *words, expect=0):
        return self.call("cluster", *RUN, "--time", "00:30:00", "--cpus", "1", "--out", "out", *words, expect=expect)

    def play(self, element):
        environment = dict(self.environment, SLURM_ARRAY_TASK_ID=str(element))
        return subprocess.run(["bash", self.dir / "out/array.sbatch"], capture_output=True, text=True, env=environment,
                              cwd="/", timeout=300)

    def test_elements_make_the_same_run(self):
        said = self.cluster("--elements", "3").stdout
        self.assertRegex(said, r"^28 cells in 3 elements; the longest takes an unknown time, at least \d+ s on 1 cores, by cells measured elsewhere")
        self.assertIn(f"To submit: {self.dir}/out/submit", said)
        script = (self.dir / "out/array.sbatch").read_text()
        for line in ("--array=1-3", "--cpus-per-task=1", "--time=00:30:00", "--signal=B:TERM@120", "--requeue"):
            self.assertIn(f"#SBATCH {line}\n", script)
        for element in 1, 3:
            done = self.play(element)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(list(self.dir.glob("lgabench-*")), [], "an element's scratch is gone")
        status = self.call("status", "out", expect=3).stdout
        self.assertIn("not begun: 2\nto finish: --array=2\n", status)
        self.assertEqual(self.play(2).returncode, 0)
        done = self.play(1)  # again: harmless
        self.assertIn("0 cells computed, 10 reused, 0 failed", done.stderr)
        self.assertRegex(self.call("status", "out").stdout, r" 1/3 +10 +10 +0 +0 +0 ")
        merged = subprocess.run(["bash", self.dir / "out/merge.sbatch"], capture_output=True, text=True, cwd="/",
                                env=self.environment, timeout=300)
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.call("run", *RUN, "--out", "undisturbed")
        self.assert_same_results("out/whole", "undisturbed")
        self.assertNotIn("shard", json.loads((self.dir / "out/whole/run.json").read_text()))
        self.assert_matches_schemas("undisturbed")

    def test_before_an_element_has_begun_status_says_so_and_submit_needs_slurm(self):
        self.cluster("--elements", "3")
        self.assertEqual(self.call("status", "out", expect=3).stdout,
                         f"out: 3 of 3 parts missing, none has begun\nto submit: out/submit\n")
        self.assertEqual(json.loads(self.call("status", "out", "--json", expect=3).stdout),
                         {"shards": 3, "parts": [], "array": "1-3", "absent": "1-3"})
        self.assertIn("out: the parts of a run that are not merged yet; lgabench status out", self.call("report", "out", expect=2).stderr)
        empty = self.dir / "empty"
        empty.mkdir()
        self.assertIn("not the directory of a run", self.call("status", "empty", expect=2).stderr)
        path = self.dir / "path"  # without Slurm, whatever this machine has
        path.mkdir()
        for program in ("bash", "mkdir", "seq"):
            (path / program).symlink_to(shutil.which(program))
        done = subprocess.run(["bash", self.dir / "out/submit"], capture_output=True, text=True, cwd="/", env={"PATH": str(path)}, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (127, ""))
        self.assertIn("sbatch was not found", done.stderr)
        plays = re.search(r"seq 3 \| parallel -j1 (SLURM_ARRAY_TASK_ID=\{\} bash .*array.sbatch)\n  (bash .*merge.sbatch)\n", done.stderr)
        for element in "123":  # as GNU parallel does with its argument
            subprocess.run(["bash", "-c", plays[1].replace("{}", element)], check=True, capture_output=True, env=self.environment, timeout=300)
        subprocess.run(["bash", "-c", plays[2]], check=True, capture_output=True, env=self.environment, timeout=300)
        self.assertTrue((self.dir / "out/whole/report.html").exists())

    def test_status_counts_what_failed_and_what_is_missing(self):
        self.call("run", *RUN, "--shard", "1/2", "--out", "part")
        cells = sorted((self.dir / "part/cells").iterdir())
        shutil.rmtree(cells[0])
        status = json.loads((cells[1] / "status.json").read_text())
        (cells[1] / "status.json").write_text(json.dumps({**status, "state": "failed"}))
        said = json.loads(self.call("status", "part", "--json", expect=3).stdout)
        part = said["parts"][0]
        self.assertEqual([part[name] for name in ("shard", "cells", "done", "failed", "missing")], [1, 14, 12, 1, 1])
        self.assertEqual((said["array"], said["absent"]), ("1-2", "2"))

    def test_status_counts_a_cell_once(self):
        """One that is being computed is not missing, nor is a part that is running to be run again."""
        self.call("run", *RUN, "--shard", "1/2", "--out", "part")
        cells = sorted((self.dir / "part/cells").iterdir())
        for cell in cells[:3]:
            shutil.rmtree(cell)
        cells[0].with_name(f".{cells[0].name}.1").mkdir()
        directory = os.open(self.dir / "part", os.O_RDONLY)
        self.addCleanup(os.close, directory)
        fcntl.flock(directory, fcntl.LOCK_EX)
        self.assertRegex(self.call("status", "part", expect=3).stdout,
                         r" 1/2 +14 +11 +1 +0 +2  part \(running\)\nnot begun: 2\nto finish: --array=2\n$")

    def test_status_of_two_parts_in_one_directory_is_the_whole_runs(self):
        for shard in ("1/2", "2/2", "1/2"):
            self.call("run", *RUN, "--shard", shard, "--out", "both")
        self.assert_matches_schemas("both")
        self.assertRegex(self.call("status", "both").stdout, r" 1/1 +28 +28 +0 +0 +0 ")
        shutil.rmtree(next((self.dir / "both/cells").iterdir()))
        self.assertRegex(self.call("status", "both", expect=3).stdout, r" 1/1 +28 +27 +0 +0 +1 ")

    def test_status_counts_as_failed_what_a_report_leaves_out(self):
        self.call("run", *RUN, "--out", "run")
        self.call("status", "run")
        cells = sorted((self.dir / "run/cells").iterdir())
        with (cells[0] / "timing.json").open("a") as timing:
            timing.write(" ")  # its checksum alone says so
        (cells[1] / "status.json").unlink()
        done = self.call("status", "run", expect=3)
        self.assertRegex(done.stdout, r" 1/1 +28 +26 +0 +2 +0  run\nto finish: --array=1\n")
        left_out = [line for line in self.call("report", "run", expect=2).stderr.splitlines() if line.startswith("left out: ")]
        self.assertEqual(sorted(done.stderr.splitlines()), sorted(left_out))
        self.assertEqual(len(left_out), 2)
        self.call("run", *RUN, "--out", "run")
        self.assertEqual(self.call("status", "run").stderr, "")

    def test_a_merge_that_lacks_a_cell_is_no_success(self):
        self.cluster("--elements", "2")

        def merged():
            return subprocess.run(["bash", self.dir / "out/merge.sbatch"], capture_output=True, text=True, cwd="/",
                                  env=self.environment, timeout=300)

        self.play(1)
        done = merged()  # though element 2 never ran
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("14 cells finished, 0 failed, 0 left out, 14 in none of the runs\n", done.stderr)
        self.call("merge", "some", "out/part-1", "--partial")
        self.play(2)
        torn = next((self.dir / "out/part-2/cells").glob("*/episodes.jsonl"))
        torn.write_bytes(torn.read_bytes().replace(b":1", b":0", 1))
        for words in ([], ["--partial"]):
            said = self.call("merge", "all", "out/part-1", "out/part-2", *words, expect=3).stderr
            self.assertIn("27 cells finished, 0 failed, 1 left out, 0 in none of the runs\n", said)
        self.assertEqual(merged().returncode, 3)
        self.play(2)
        self.assertEqual(merged().returncode, 0)
        self.call("merge", "some", "out/part-2")  # into what the other part was merged into

    def test_what_is_wrong_is_said_before_anything_is_written(self):
        for words, reason in [(("--elements", "99"), "--elements 99: the run has 28 cells"),
                              (("--elements", "2", "--seeds", "x"), "--seeds: expected whole numbers"),
                              (("--elements", "2", "--time", "2h"), "--time 2h: expected HH:MM:SS"),
                              (("--elements", "2", "--time", "00:02:30"), "--time 00:02:30: expected 300 s at least: an "
                               "element stops 120 s before its limit"),
                              (("--elements", "2", "--out", 'a "b"'), 'a "b"/logs/%A_%a.txt: expected no quote'),
                              (("--elements", "2", "--fresh"), "--fresh: an option of run only"),
                              (("--elements", "2", "--dry-run"), "--dry-run: an option of run only"),
                              (("--elements", "2", "--debug", "0"), "--debug: an option of run only")]:
            with self.subTest(words):
                done = self.call("cluster", *with_options(RUN + ("--time", "00:30:00", "--out", "out"), *words), expect=2)
                self.assertIn(reason, done.stderr)
                self.assertFalse((self.dir / "out").exists())

    def test_a_path_with_blanks_and_percent_signs(self):
        out = self.dir / "my runs/it's %j"
        self.call("cluster", *RUN, "--time", "00:30:00", "--cpus", "1", "--elements", "1", "--out", out)
        self.assertIn(f'#SBATCH --output="{self.dir}/my runs/it\'s %%j/logs/%A_%a.txt"\n', (out / "array.sbatch").read_text())
        self.assertIn(f'#SBATCH --output="{self.dir}/my runs/it\'s %%j/logs/merge_%j.txt"\n', (out / "merge.sbatch").read_text())
        for script in out / "array.sbatch", out / "merge.sbatch":
            done = subprocess.run(["bash", script], capture_output=True, text=True, cwd="/", timeout=300,
                                  env=dict(self.environment, SLURM_ARRAY_TASK_ID="1"))
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_smoke_runs_cells_tell_the_time(self):
        self.call("run", *with_options(RUN, "--demos", "2", "--seeds", "0"), "--out", "smoke")
        for cell in (self.dir / "smoke/cells").iterdir():
            timing = json.loads((cell / "timing.json").read_text())
            (cell / "timing.json").write_text(json.dumps({**timing, "total_s": 3600}))
        said = self.cluster("--elements", "2", "--timings", "smoke").stdout
        self.assertIn("by the cells of smoke", said)
        self.assertRegex(said, r"--time 00:30:00 is too short for that: \d+ elements would fit")


@unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays it")
@unittest.skipUnless(SLURM, "Slurm (slurm-wlm) is not installed")
class Slurm(Case):
    """slurmctld and two slurmd of this user's own, in this test's directory and on ports of their own."""

    def setUp(self):
        super().setUp()
        host = os.uname().nodename
        user = getpass.getuser()
        (self.dir / "slurm.conf").write_text(textwrap.dedent(f"""\
            ClusterName=test
            SlurmctldHost={host}(127.0.0.1)
            SlurmctldPort=16817
            AuthType=auth/none
            CredType=cred/none
            ProctrackType=proctrack/linuxproc
            TaskPlugin=task/none
            MpiDefault=none
            ReturnToService=2
            SlurmUser={user}
            SlurmdUser={user}
            StateSaveLocation={self.dir}/state
            SlurmdSpoolDir={self.dir}/spool.%n
            SlurmctldPidFile={self.dir}/ctld.pid
            SlurmdPidFile={self.dir}/%n.pid
            SlurmctldLogFile={self.dir}/ctld.log
            SlurmdLogFile={self.dir}/%n.log
            SelectType=select/cons_tres
            SelectTypeParameters=CR_Core
            JobAcctGatherType=jobacct_gather/none
            AccountingStorageType=accounting_storage/none
            NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port=16818 CPUs=1 RealMemory=16000
            NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port=16819 CPUs=1 RealMemory=16000
            PartitionName=p Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE
            """))
        (self.dir / "state").mkdir()
        self.environment["SLURM_CONF"] = str(self.dir / "slurm.conf")
        for words in (["slurmctld", "-D"], ["slurmd", "-D", "-N", "n1"], ["slurmd", "-D", "-N", "n2"]):
            process = subprocess.Popen(words, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.addCleanup(process.wait)
            self.addCleanup(process.terminate)

    def slurm(self, *words):
        done = subprocess.run(list(map(str, words)), env=self.environment, capture_output=True, text=True, timeout=60, cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def wait(self):
        for _ in range(600):
            if not self.slurm("squeue", "-h").strip():
                return
            time.sleep(.5)
        self.fail(self.slurm("squeue") + (self.dir / "ctld.log").read_text()[-3000:])

    def test_an_array_with_an_element_killed_makes_the_same_run(self):
        for _ in range(60):
            if subprocess.run(["scontrol", "ping"], env=self.environment, capture_output=True).returncode == 0:
                break
            time.sleep(.5)
        run = with_options(RUN, "--seeds", "0:10")
        self.call("cluster", *run, "--elements", "4", "--time", "00:10:00", "--cpus", "1", "--memory", "1", "--out", "out")
        job = self.slurm("sbatch", "--parsable", "out/array.sbatch").strip()
        for _ in range(600):
            if list(self.dir.glob("out/part-1/cells/*/status.json")):
                break
            time.sleep(.1)
        self.slurm("scancel", "--signal=KILL", "--full", f"{job}_1")
        self.wait()
        said = json.loads(self.call("status", "out", "--json", expect=3).stdout)
        self.assertIn("1", said["array"], "the element that was killed is to be played again")
        self.slurm("bash", "out/submit", f"--array={said['array']}")
        self.wait()
        self.call("status", "out")
        self.call("run", *run, "--out", "undisturbed")
        self.assert_same_results("out/whole", "undisturbed")


@unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays it")
@unittest.skipUnless(SSHD and shutil.which("parallel"), "GNU parallel (parallel) or sshd (openssh-server) is not installed")
class OverSsh(Case):
    """Two hosts that are this machine: an sshd of this user's own, on a port and with keys of its own."""

    def setUp(self):
        super().setUp()
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        for key in "host", "user":
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", self.dir / key], check=True)
        (self.dir / "known_hosts").write_text(f"[127.0.0.1]:{port} {(self.dir / 'host.pub').read_text()}")
        self.environment.update(PATH=f"{self.dir}/bin:{os.environ['PATH']}", PARALLEL_HOME=str(self.dir),
                                PARALLEL_SSH=f"ssh -F {self.dir}/ssh_config")
        (self.dir / "ssh_config").write_text(textwrap.dedent(f"""\
            Host host1 host2
            HostName 127.0.0.1
            Port {port}
            IdentityFile {self.dir}/user
            IdentitiesOnly yes
            UserKnownHostsFile {self.dir}/known_hosts
            BatchMode yes
            """))
        there = " ".join(f'{name}="{self.environment[name]}"' for name in ("PATH", "LGABENCH_CACHE", "TMPDIR"))
        (self.dir / "sshd_config").write_text(textwrap.dedent(f"""\
            ListenAddress 127.0.0.1:{port}
            HostKey {self.dir}/host
            AuthorizedKeysFile {self.dir}/user.pub
            PasswordAuthentication no
            KbdInteractiveAuthentication no
            StrictModes no
            PidFile none
            SetEnv {there}
            """))
        if os.geteuid() == 0:
            pathlib.Path("/run/sshd").mkdir(exist_ok=True)  # which Debian's service makes
        with (self.dir / "sshd.log").open("w") as log:
            server = subprocess.Popen([SSHD, "-D", "-e", "-f", self.dir / "sshd_config"], stderr=log)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        for _ in range(100):
            if "Server listening" in (self.dir / "sshd.log").read_text():
                break
            time.sleep(.1)

    def test_the_documents_lines_make_the_same_run(self):
        (self.dir / "bin").mkdir()
        small = self.dir / "bin/lgabench"  # the run is smaller than the document's
        small.write_text(f'#!/bin/sh\n[ "$1" != run ] || set -- "$@" {shlex.join(map(str, RUN[1:]))}\nexec {PROGRAM} "$@"\n')
        small.chmod(0o755)
        lines = re.search(r"\n## GNU parallel over ssh\n[^#]*?\n\n((?:    .+\n)+)", PAGE.read_text())[1].splitlines()
        self.assertEqual(len(lines), 3)
        for line in lines:
            done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, env=self.environment, cwd=self.dir,
                                  timeout=600)
            self.assertEqual(done.returncode, 0, done.stderr + (self.dir / "sshd.log").read_text())
        self.assertGreaterEqual((self.dir / "sshd.log").read_text().count("Accepted publickey for "), 8)
        self.call("run", *RUN, "--out", "undisturbed")
        self.assert_same_results("whole", "undisturbed")


if __name__ == "__main__":
    unittest.main(verbosity=2)
