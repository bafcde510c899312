"""lgabench's suites as tasks of Inspect, `inspect eval lgabench/words -T form=structured`; the entry point of the wheel names this."""
from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessageSystem, ChatMessageUser, GenerateConfig
from inspect_ai.scorer import Metric, SampleScore, Score, Scorer, Target, metric, scorer
from inspect_ai.solver import TaskState, generate

from lgabench import evals


@metric
def of_the_suite() -> Metric:
    """What `lgabench select --score` says of all replies together."""
    def compute(scores: list[SampleScore]) -> dict[str, float]:
        return evals.score_or_nan(one.score.metadata["reply"] for one in scores)  # type: ignore[index]
    return compute


@scorer(metrics=[of_the_suite()])
def replied() -> Scorer:
    """1 for a reply that was neither cut off nor refused: a single one is not right or wrong. Only these are scored together."""
    async def score(state: TaskState, target: Target) -> Score:
        whole = state.output.stop_reason in ("stop", "unknown")
        reply = {"suite": state.metadata["suite"], "form": state.metadata["form"], "id": str(state.sample_id),
                 "reply": state.output.completion if whole else ""}
        return Score(value=int(whole), answer=state.output.completion, metadata={"reply": reply})
    return score


def suite_task(suite: str, form: str) -> Task:
    samples = [Sample(id=one["id"], input=[ChatMessageSystem(content=one["system"]), ChatMessageUser(content=one["user"])],
                      metadata={name: one[name] for name in ("suite", "form", "command", "about")})
               for one in evals.questions(suite, form)]
    return Task(dataset=MemoryDataset(samples), solver=generate(), scorer=replied(), config=GenerateConfig(temperature=0))


def _register(suite: str) -> None:
    @task(name=suite)
    def of_suite(form: str = "flat") -> Task:
        return suite_task(suite, form)


for _suite in evals.suites():
    _register(_suite)


@task
def own(suite: str, form: str = "flat") -> Task:
    """A suite in a file of one's own."""
    return suite_task(suite, form)
