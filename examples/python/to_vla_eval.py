"""Scenarios as a benchmark of vla-evaluation-harness, whose model servers (OpenVLA, pi0, your own) then act in them:

    v/bin/pip install vla-eval "$(echo dist/lgabench-*.whl)[gym]"
    PYTHONPATH=examples/python v/bin/vla-eval run --config lgabench.yaml

where lgabench.yaml has

    server: {url: "ws://localhost:8000"}
    benchmarks:
      - benchmark: "to_vla_eval:Scenarios"
        episodes_per_task: 100
        params: {scenarios: [heart, plain_colored_vessel], arm: near_4}

A scenario is a task, and episode i its test scene i. The server gets {"images": {"top": rows x columns x 3 bytes}, "task_description"},
with "state" where the task has one, and replies {"actions": numbers of [-1, 1]}: those of the Gymnasium environment, over the
bounds of its action. What it succeeds in is no entry of the leaderboard: the server may have seen anything.
"""
import numpy
from lgabench.gym import SceneEnv
from vla_eval.benchmarks.base import StepBenchmark, StepResult
from vla_eval.specs import DimSpec


class Scenarios(StepBenchmark):
    render_backends = frozenset({"cpu", "gpu"})  # nothing here draws by OpenGL

    def __init__(self, scenarios, split="test", arm=None, engine=None):
        super().__init__()
        self.environments = {scenario: SceneEnv(scenario, split=split, arm=arm, engine=engine) for scenario in scenarios}

    @classmethod
    def configure_render(cls, mode):
        return {}

    def get_tasks(self):
        return [{"name": scenario, "suite": "lgabench"} for scenario in self.environments]

    def reset(self, task):
        self.environment = self.environments[task["name"]]
        return self.environment.reset(seed=task["episode_idx"])[0]

    def step(self, action):
        seen, reward, terminated, truncated, info = self.environment.step(numpy.asarray(action["actions"], numpy.float32))
        return StepResult(seen, reward, terminated or truncated, info)

    def make_obs(self, raw_obs, task):
        state = {"state": raw_obs["state"]} if "state" in raw_obs else {}
        return {"images": {"top": raw_obs["rgb"]}, **state, "task_description": raw_obs["instruction"]}

    def get_step_result(self, step_result):
        return {"success": bool(step_result.info.get("is_success")), "failure": step_result.info.get("failure")}

    def get_action_spec(self):
        return {"action": DimSpec("action", max(len(one.action_space.low) for one in self.environments.values()), "lgabench", (-1, 1))}

    def get_observation_spec(self):
        return {"top": DimSpec("top", 0, "rgb"), "task_description": DimSpec("task_description", 0, "language")}

    def get_metadata(self):
        return {"max_steps": max(one.scenario.most_steps for one in self.environments.values())}

    def cleanup(self):
        for one in self.environments.values():
            one.close()
