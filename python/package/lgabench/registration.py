"""Gymnasium's registry: an id for each shipped scenario, and lgabench/own-v1 for a file of one's own."""
import json
import pathlib

from gymnasium.envs.registration import register as _register, registry

from lgabench import _core

# {id: {"version": N, "seen": {"LAYOUT/ARM": hash}}}: a test compares what is seen with it (tests/python).
VERSIONS = pathlib.Path(__file__).with_name("versions.json")


def names() -> dict[str, str]:
    """Scenario -> the id of its environment."""
    versions = json.loads(VERSIONS.read_text())
    return {scenario: f"lgabench/{scenario}-v{versions.get(scenario, {}).get('version', 1)}" for scenario in _core.scenarios()}


def register() -> None:
    """Adds them all, once."""
    for scenario, name in names().items():
        _add(name, {"scenario": scenario})
    _add("lgabench/own-v1", {})


def _add(name: str, arguments: dict[str, object]) -> None:
    if name not in registry:
        _register(name, "lgabench.gym:SceneEnv", vector_entry_point="lgabench.gym:SceneVectorEnv", kwargs=arguments)
