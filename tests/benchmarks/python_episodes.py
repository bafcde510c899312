"""Seconds of an episode, by one of three ways: binding, threads, sync. Usage: python_episodes.py HOW"""
import sys
import time

try:
    import gymnasium
    import lgabench
except ImportError:
    sys.exit(77)

N, EPISODES = 8, 400


def binding():
    env = lgabench.Environment("heart", layout="cells")
    for index in range(20):
        env.reset("test", index)
    start = time.process_time()
    for index in range(EPISODES):
        env.reset("test", index % 100)
        env.step(env.expert_action())
    return (time.process_time() - start) / EPISODES


def vector(**arguments):
    envs = gymnasium.make_vec("lgabench/heart-v1", N, layout="cells", split="test", **arguments)
    envs.reset(seed=0)
    actions = envs.action_space.sample()
    start = time.perf_counter()
    for _ in range(EPISODES // N):
        envs.step(actions)
    return (time.perf_counter() - start) / EPISODES


def sync():
    mode = gymnasium.vector.AutoresetMode.SAME_STEP
    return vector(vectorization_mode="sync", stride=N, vector_kwargs={"autoreset_mode": mode})


print({"binding": binding, "threads": lambda: vector(threads=2), "sync": sync}[sys.argv[1]]())
