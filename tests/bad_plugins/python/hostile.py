"""What fixture_hostile.cpp and fixture_cheat.cpp try, from Python."""
import ctypes
import mmap
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import threading
import time

from lgabench_method import Needs, Selection

FE_TOWARDZERO = 0xc00


def attempt(what, act):
    """Tries; prints and tells whether that was refused."""
    try:
        act()
    except Exception as error:  # noqa: BLE001  whatever stands in its way
        print(f"{what}: refused ({type(error).__name__})")
        return False
    print(f"{what}: reached")
    return True


def damage(run, cache):
    """Other cells, and the demonstrations that other methods will learn from."""
    attempt("run.json", lambda: open(run + "/run.json", "w"))
    attempt("cells", lambda: shutil.rmtree(run + "/cells"))
    attempt("a link", lambda: os.symlink("/etc/hostname", run + "/leak.txt"))
    attempt("the cache", lambda: open(cache + "/planted.hdf5", "w"))


def leave_a_daemon():
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            signal.pause()
        os._exit(0)


def fill_shared_memory():
    memory = mmap.mmap(-1, 1 << 30)
    for _ in range(1 << 6):
        memory.write(b"x" * (1 << 24))
    time.sleep(2)


def start_processes():
    """4,000 of a program that lies beside this file."""
    subprocess.Popen([pathlib.Path(__file__).with_name("many"), "4000"])
    time.sleep(20)  # far longer than a look takes, also on a busy machine


def start_threads():
    threading.stack_size(1 << 16)
    for _ in range(4000):
        threading.Thread(target=signal.pause, daemon=True).start()
    time.sleep(20)


def kill_itself():
    os.kill(os.getpid(), signal.SIGKILL)


def cheat():
    """Looks for the truth and the scenes wherever they could be; raises with what it found."""
    data, worker = os.environ["LGABENCH_DATA"], f"/proc/{os.getppid()}"
    prefix = pathlib.Path(data).parent.parent
    ways = {"standard input": lambda: open("/proc/self/fd/0").read()[0],
            "the worker's job": lambda: open(worker + "/fd/0").read()[0],
            "the worker's memory": lambda: open(worker + "/mem", "rb"),
            "the worker's command": lambda: open(worker + "/cmdline"),
            "the scenario": lambda: open(data + "/scenarios/heart.json"),
            "the suite": lambda: open(data + "/suites/q1.json"),
            "the answers": lambda: open(data + "/answers/gpt4_released.json"),
            "the sampler": lambda: subprocess.run([prefix / "bin/lgabench", "list"])}
    reached = [way for way, act in ways.items() if attempt(way, act)]
    raise RuntimeError("reached: " + (", ".join(reached) or "nothing"))


class Hostile:
    version = "0.1"
    summary = "tries to do harm beyond its own cell"
    options = {"how": {"default": "", "help": "what it tries", "source": "test"},
               "run": {"default": "", "help": "the run's directory", "source": "test"},
               "cache": {"default": "", "help": "the directory of demonstrations", "source": "test"}}

    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        if services.options["how"] == "people":
            return services.human.specify(command)
        if services.options["how"] == "cheat":
            cheat()
        return Selection()

    def learn(self, demonstrations, services):
        how = services.options["how"]
        if how == "rounding":
            ctypes.CDLL("libm.so.6").fesetround(FE_TOWARDZERO)
        elif how == "others":
            damage(services.options["run"], services.options["cache"])
        elif how == "link":
            os.symlink("/etc/passwd", services.files + "/leak.txt")
        elif how == "directory_link":  # which leads to what its worker may read
            os.rmdir(services.files)
            os.symlink("/etc", services.files)
        elif how == "loss":  # so large that adding 1 changes nothing
            services.log.epoch(1, 1, 1.8e19)
            return Stay()
        elif how == "epoch":
            services.log.epoch(0, 1, 0)
        elif how == "shared_memory":
            fill_shared_memory()
        elif how == "processes":
            start_processes()
        elif how == "threads":
            start_threads()
        elif how == "daemon":
            leave_a_daemon()
        elif how == "fork":
            os.fork()  # both go on
        elif how == "kill" or (how == "game" and services.seed != 1):
            kill_itself()
        elif how == "spoof":
            os.write(3, b'{"reason": "the disk is full", "fault": "host"}\n')
        elif how == "input_error":
            raise OSError("run.json: the disk is full")
        elif how == "descriptors":
            resource.setrlimit(resource.RLIMIT_NOFILE, (1, 1))
        elif how == "flood":
            for _ in range(50000):
                print("the fixture prints a line of fifty bytes, over and over")
        elif how == "exit_4":
            os._exit(4)
        services.log.epoch(1, len(demonstrations), 0.0)
        return Stay()


class Stay:
    """Takes up what lies at the workspace's centre and puts it down there."""

    def act(self, observation, instruction):
        return [0.5, 0, 0, 0, 0, 1] * 2
