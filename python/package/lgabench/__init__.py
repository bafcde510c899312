"""lgabench in Python: scenes to step, Gymnasium environments, demonstrations and runs to read (docs/python.md).

    env = lgabench.Environment("heart")
    seen = env.reset("test", 0)
    env.step(env.expert_action()).success

`import lgabench` registers "lgabench/heart-v1" and the other scenarios where Gymnasium is installed.
"""
import importlib.util
import os
import sys

os.environ.setdefault("LGABENCH_PYTHON", sys.executable)  # of environments in Python, as of methods

from lgabench._core import EngineError, engines, scenarios, version as __version__
from lgabench.evaluation import Result, evaluate
from lgabench.kept import Policy, load_policy
from lgabench.scenes import ActionSpace, Batch, Environment, Pool, Scenario, Station, StepResult

__all__ = ["ActionSpace", "Batch", "EngineError", "Environment", "Policy", "Pool", "Result", "Scenario", "Station", "StepResult",
           "__version__", "engines", "evaluate", "load_policy", "scenarios"]

if importlib.util.find_spec("gymnasium"):
    from lgabench import registration as _registration
    _registration.register()
