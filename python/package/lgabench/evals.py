"""A suite's questions as tasks of language-model harnesses (docs/language-models.md): what both share, and lm-evaluation-harness.

    python -m lgabench.evals tasks            # then: lm_eval --include_path tasks --tasks lgabench_words_structured ...

Inspect finds its tasks by their entry point (inspect_tasks.py). Neither is imported here before a log of it is read.
"""
from __future__ import annotations

import argparse
import functools
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import warnings
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence

from lgabench.__main__ import PROGRAM
from lgabench.kept import ending

FORMS = ("flat", "structured")  # yes or no of each feature; what the command means
METRICS = ("scenes_exact", "exact_sets", "precision", "recall", "answered")
UNANSWERED = 3  # exit status
ANSWER_TOKENS = 4096  # of a reply in lm-evaluation-harness, whose default of 256 cuts reasoning off
# Members of a request that a log of Inspect names as its server does.
SENT = ("temperature", "top_p", "top_k", "max_tokens", "seed", "frequency_penalty", "presence_penalty", "reasoning_effort")
Reply = dict[str, Any]  # as `lgabench answers --from` reads a line


def suites() -> list[str]:
    """Ids of the shipped suites."""
    return sorted(file.stem for file in (PROGRAM.parents[1] / "share/lgabench/suites").glob("*.json"))


def _call(*words: object, also: int = 0) -> str:
    """What the program prints. ValueError for an exit status other than 0 and `also`."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, also):
        raise ValueError("; ".join(done.stderr.strip().splitlines()[-3:]) or f"lgabench {words[0]}: {ending(done.returncode)}")
    return done.stdout


def _whole(suite: str) -> str:
    return str(pathlib.Path(suite).resolve()) if suite.endswith(".json") else suite


def questions(suite: str, form: str = "flat") -> list[dict[str, str]]:
    """The questions about the suite's commands, each once, with `id`; `system` and `user`, the messages for the model; and
    `suite`, `form`, `command` and `about` for a reader. ValueError for an unknown suite or form."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "questions.jsonl")
        _call("answers", _whole(suite), "--form", form, "--questions", file)
        return [json.loads(line) for line in file.read_text().splitlines()]


def score(replies: Iterable[Reply], scenes: int = 30) -> dict[str, float]:
    """METRICS of replies to all questions of one suite in one form, by `lgabench select --score`; nan for a share of nothing.
    `answered` is the share of the commands whose replies can be read; the others are in no other metric. ValueError names
    questions without a reply that is yes or no, for which there is no score."""
    replies = list(replies)
    (suite, form), = {(reply["suite"], reply["form"]) for reply in replies}
    with tempfile.TemporaryDirectory() as folder:
        lines, cassette = pathlib.Path(folder, "replies.jsonl"), pathlib.Path(folder, "cassette.jsonl")
        lines.write_text("".join(json.dumps(reply) + "\n" for reply in replies))
        _call("answers", "--from", lines, "--model", "model", "--cassette", cassette)
        said = _call("select", "--suite", suite, "--score", "--json", "--scenes", scenes, "--answers", f"cassette:{cassette}",
                     also=UNANSWERED)
    row, = (row for row in map(json.loads, said.splitlines()) if (row["group"], row["asked"]) == ("all", form))
    row["all"] = row["commands"] + row["unanswered"]
    shares = (("exact_scenes", "scenes"), ("exact_sets", "commands"), ("right", "kept"), ("right", "meant"), ("commands", "all"))
    return {name: row[part] / row[of] if row[of] else math.nan for name, (part, of) in zip(METRICS, shares)}


def score_or_nan(replies: Iterable[Reply]) -> dict[str, float]:
    """score(), where a harness needs numbers: nan, with a warning that says why, where there is none."""
    try:
        return score(replies)
    except ValueError as e:
        warnings.warn(f"no score: {e}", stacklevel=2)
        return dict.fromkeys(METRICS, math.nan)


# lm-evaluation-harness: a task is a file, which names these functions.

def process_results(doc: Mapping[str, str], results: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """What every metric's aggregation needs of the reply to one question."""
    return dict.fromkeys(METRICS, (doc["suite"], doc["form"], doc["id"], results[0] or ""))


@functools.lru_cache(1)
def _of_items(items: tuple[tuple[str, ...], ...]) -> dict[str, float]:
    return score_or_nan(dict(zip(("suite", "form", "id", "reply"), item)) for item in items)


def _aggregation(metric: str) -> Callable[[Iterable[Sequence[str]]], float]:
    def of_all(items: Iterable[Sequence[str]]) -> float:
        return _of_items(tuple(map(tuple, items)))[metric]
    of_all.__doc__ = f"{metric} of all questions' results, as process_results() gives them."
    return of_all


scenes_exact, exact_sets, precision, recall, answered = map(_aggregation, METRICS)


def write_tasks(folder: pathlib.Path, ids: Iterable[str]) -> list[str]:
    """Writes for each suite and form a task, lgabench_SUITE_FORM, and its questions. Returns the tasks' names."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for suite in ids:
        for form in FORMS:
            name = f"lgabench_{pathlib.Path(suite).stem}_{form}"
            data = folder.resolve() / f"{name}.jsonl"
            _call("answers", _whole(suite), "--form", form, "--questions", data)
            (folder / f"{name}.yaml").write_text(f"""task: {name}
dataset_path: json
dataset_kwargs: {json.dumps({"data_files": {"test": str(data)}})}
test_split: test
output_type: generate_until
description: "{{{{system}}}}"
doc_to_text: "{{{{user}}}}"
doc_to_target: id
process_results: !function lgabench.evals.process_results
generation_kwargs: {{until: [], do_sample: false, temperature: 0, max_gen_toks: {ANSWER_TOKENS}}}
metric_list:
""" + "".join(f"  - {{metric: {metric}, aggregation: !function lgabench.evals.{metric}, higher_is_better: true}}\n"
                        for metric in METRICS) + "metadata: {version: 2}\n")
            names.append(name)
    return names


# Logs.

def replies_of(log: pathlib.Path) -> tuple[list[Reply], str, dict[str, Any]]:
    """Replies of a finished log, with the messages that the model was shown; the model's name, "" where the log has none; and how
    its requests differed from lgabench's own. Of Inspect: .eval or .json; of lm-evaluation-harness: samples_*.jsonl
    (`--log_samples`)."""
    return _of_inspect(log) if log.suffix in (".eval", ".json") else _of_lm_eval(log)


def _of_inspect(file: pathlib.Path) -> tuple[list[Reply], str, dict[str, Any]]:
    from inspect_ai.log import read_eval_log

    log = read_eval_log(str(file))
    sent = log.plan.config.model_dump(exclude_none=True)
    request = {name: sent[name] for name in SENT if name in sent}
    replies = []
    for sample in log.samples or []:
        output = sample.output
        if sample.error or not output.choices or output.stop_reason not in ("stop", "unknown"):
            continue  # cut off or refused: lgabench takes no answer from such a reply either
        system, user = (message.text for message in sample.messages[:2])
        replies.append({"suite": sample.metadata["suite"], "form": sample.metadata["form"], "id": str(sample.id), "system": system,
                        "user": user, "reply": output.completion, "seconds": output.time or 0.,
                        **({"served": output.model} if output.model else {}), **_tokens_of(output.usage)})
    return replies, log.eval.model, request


def _tokens_of(usage: Any) -> dict[str, int]:
    if not usage:
        return {}
    return {"tokens": usage.total_tokens, "prompt_tokens": usage.input_tokens, "reply_tokens": usage.output_tokens}


def _of_lm_eval(file: pathlib.Path) -> tuple[list[Reply], str, dict[str, Any]]:
    replies, request = [], {}
    for line in map(json.loads, file.read_text().splitlines()):
        if "doc" not in line:
            raise ValueError(f"{file}: expected a log of Inspect (.eval, .json) or of lm-evaluation-harness (samples_*.jsonl)")
        doc, (shown, arguments) = line["doc"], (line["arguments"]["gen_args_0"][name] for name in ("arg_0", "arg_1"))
        request = {"max_tokens": arguments["max_gen_toks"], "temperature": arguments.get("temperature", 0)}
        replies.append({**{name: doc[name] for name in ("suite", "form", "id")}, **dict(zip(("system", "user"), _shown(shown, doc))),
                        "reply": line["resps"][0][0]})
    results = file.with_name(f"results_{file.stem.rpartition('_')[2]}.json")
    model = json.loads(results.read_text()).get("model_name") if results.exists() else ""
    return replies, model or "", request


def _shown(prompt: str | list[str], doc: Mapping[str, str]) -> Iterator[str]:
    """System and user message that an API was sent as JSON; a chat template's text around the two counts as them."""
    text = prompt if isinstance(prompt, str) else prompt[0]
    if text.startswith("[{"):
        return (message["content"] for message in json.loads(text)[:2])
    return (doc[name] if doc[name].strip() in text else text for name in ("system", "user"))


def answers(words: Sequence[str]) -> int:
    """`lgabench answers`, whose --from may name a log. Returns the exit status."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for name in "--from", "--model", "--request":
        parser.add_argument(name)
    known, rest = parser.parse_known_args(list(words))
    log = vars(known)["from"]
    if not log or not _is_log(pathlib.Path(log)):
        return subprocess.call([PROGRAM, "answers", *words])
    try:
        replies, model, request = replies_of(pathlib.Path(log))
        text = "".join(json.dumps(reply) + "\n" for reply in replies)
        more = ["--model", known.model or model, "--request", known.request or json.dumps(request)]
        with tempfile.TemporaryDirectory() as folder:
            lines = pathlib.Path(folder, "replies.jsonl")
            lines.write_text(text)
            return subprocess.call([PROGRAM, "answers", "--from", lines, *more, *rest])
    except Exception as e:  # a log is a stranger's: any member may be of any type, size and depth
        print(f"lgabench: {log}: no log of lgabench's tasks: {type(e).__name__}: {' '.join(str(e).split())[:300]}", file=sys.stderr)
        return 2


def _is_log(file: pathlib.Path) -> bool:
    if not file.is_file() or file.suffix in (".eval", ".json"):
        return file.is_file()
    with file.open("rb") as lines:
        return b'"doc_id"' in lines.readline(1 << 20)


def main() -> None:
    """python -m lgabench.evals; exits with its status."""
    parser = argparse.ArgumentParser(prog="python -m lgabench.evals", description="Write tasks for lm-evaluation-harness.")
    parser.add_argument("folder", type=pathlib.Path, help="where to, for lm_eval --include_path")
    parser.add_argument("--suites", type=lambda text: text.split(","), default=suites(),
                        help="these, as SUITE,...; a file.json is a suite of your own (default: all shipped ones)")
    arguments = parser.parse_args()
    print("\n".join(write_tasks(arguments.folder, arguments.suites)))


if __name__ == "__main__":
    main()
