#!/usr/bin/env python3
"""Writes the tables of members in docs/formats from the schemas there; those of docs/formats/method-protocol.md
between `<!-- messages:... -->` and `<!-- /messages -->`.

Usage: docs/members.py [OUTPUT_DIR]
"""
import json
import pathlib
import re
import sys

FORMATS = pathlib.Path(__file__).parent / "formats"

# page -> its title, and its schemas in their order.
PAGES = {
    "run-members": ("Members of a run's files", [
        "run", "cell", "selection", "training", "episodes", "perturbed", "timing", "status", "shown", "summary", "claims", "report_data",
        "compare", "verify", "rescored", "check_plugin"]),
    "input-members": ("Members of scenarios, suites and answers", [
        "scenario", "suite", "suite_claims", "lexicon", "recorded_answers", "cassette", "disputed", "paper_claims", "paper_methods"]),
    "study-members": ("Members of a study's files", ["study_protocol", "participant", "study_events", "study_results"]),
    "leaderboard-members": ("Members of the leaderboard's files", [
        "entry", "entry_meta", "cells", "verifications", "vouched", "vouched_entries", "instructions", "labels", "tracks", "scenes"]),
}
STRINGS = {"^[0-9a-f]{16}$": "16 hex digits", "^[0-9a-f]{32}$": "32 hex digits", "^[0-9a-f]{40}$": "40 hex digits", "^[0-9a-f]{64}$": "SHA-256"}
ENDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


class Schema:
    """A schema as rows of a table: its members, then its own definitions of objects under their names in capitals."""

    def __init__(self, name):
        self.name, self.root = name, json.loads((FORMATS / f"{name}.schema.json").read_text())
        self.head, _, self.what = self.root["title"].partition(": ")
        self.used = []

    def resolved(self, node):
        """(what the node refers to, the name of a definition that has rows of its own, or "")."""
        if "$ref" not in node:
            return node, ""
        _, kind, name = node["$ref"].split("/")
        target = self.root[kind][name]
        if kind == "definitions" and any("properties" in one for one in [target, target.get("items", {}), *target.get("oneOf", [])]):
            if name not in self.used:
                self.used.append(name)
            return target, name.upper()
        return self.resolved(target)

    def value(self, node):
        node, name = self.resolved(node)
        if name:
            return name
        if "const" in node or "enum" in node:
            return ", ".join(f"`{one if isinstance(one, str) else json.dumps(one)}`" for one in node.get("enum", [node.get("const")]))
        kind = node.get("type")
        if kind is None:
            return " or ".join(dict.fromkeys(self.value(one) for one in node.get("oneOf", node.get("anyOf", [])))) or "any value"
        if isinstance(kind, list):
            return " or ".join(self.value({**node, "type": one}) for one in kind)
        if kind == "string":
            return STRINGS.get(node.get("pattern"), "text")
        if kind in ("integer", "number"):
            return f"{kind} {', '.join(f'{sign} {node[end]:g}' for end, sign in ENDS.items() if end in node)}".strip()
        of = node.get("items") if kind == "array" else node.get("additionalProperties")
        if kind == "array":
            return f"list of {self.value(of)}" if of else "list"
        if kind == "object" and isinstance(of, dict) and "properties" not in node:
            return f"object of {self.value(of)}"
        return kind

    def below(self, node, path, pointer):
        """(path, JSON pointer, optional or not, node) of all that a node holds."""
        if "$ref" in node:
            return
        dot = f"{path}." if path else ""
        for name, one in node.get("properties", {}).items():
            yield from self.row(one, dot + name, f"{pointer}/properties/{name}", name not in node.get("required", []))
        for key, name in ("items", f"{path}[]"), ("additionalProperties", f"{dot}*"):
            if isinstance(node.get(key), dict):
                yield from self.row(node[key], name, f"{pointer}/{key}", None)
        for pattern, one in node.get("patternProperties", {}).items():
            yield from self.row(one, f"{dot}*", f"{pointer}/patternProperties/{pattern}", None)
        for key in ("oneOf", "anyOf"):
            for i, one in enumerate(node.get(key, [])):
                self.resolved(one)
                if "type" in one:
                    yield from self.below(one, path, f"{pointer}/{key}/{i}")

    def row(self, node, path, pointer, optional):
        self.resolved(node)
        if optional is not None or "description" in node:  # elements are told with their list, unless there is more to say
            yield path, pointer, bool(optional), node
        yield from self.below(node, path, pointer)

    def rows(self):
        yield from self.below(self.root, "", "")
        for name in self.used:  # grows on the way
            node = self.root["definitions"][name]
            yield name.upper(), f"/definitions/{name}", False, node
            yield from self.below(node, name.upper(), f"/definitions/{name}")

    def merged(self):
        """path -> [value, optional or not, meaning], where alternatives have a member in common all of theirs."""
        merged = {}
        for path, pointer, optional, node in self.rows():
            found, own = self.resolved(node)
            meaning = node.get("description", found.get("description"))
            if not meaning:
                raise SystemExit(f"docs/formats/{self.name}.schema.json: {pointer} has no description")
            row = merged.setdefault(path, [self.value(node), optional, meaning])
            if self.value(node) not in row[0]:
                row[0] += f", {self.value(node)}"
            row[1] = row[1] and optional
        return merged


def escaped(text):
    return re.sub(r"`[^`]*`|[|*<>]", lambda found: found[0].replace("|", "\\|") if found[0][0] == "`" else "\\" + found[0], text)


def page(title, schemas):
    """What stood above on the page, definitions and long meanings, is linked to."""
    text = (f"# {title}\n\n`docs/members.py` writes this page from the schemas' descriptions.\n`[]` stands for each element of a list, `*` for each name in an "
            "object.\n[Formats](README.md) says which file is what.\n")
    told, defined = {}, {}
    for schema in map(Schema, schemas):
        anchor = re.sub(r"[^\w\- ]", "", schema.head.lower()).replace(" ", "-")
        text += f"\n## {schema.head}\n{schema.what[0].upper()}{schema.what[1:]} ([schema]({schema.name}.schema.json)).\n\n"
        if "description" in schema.root:
            text += f"{schema.root['description']}\n\n"
        text += "| member | value | meaning |\n| --- | --- | --- |\n"
        merged, links = schema.merged(), {}
        for name in map(str.upper, schema.used):
            rows = tuple((path, *row) for path, row in merged.items() if re.match(rf"{name}\b", path))
            if (where := defined.setdefault(rows, anchor)) != anchor:
                links[name] = where
        for path, (value, optional, meaning) in merged.items():
            if re.match(r"\w*", path)[0] in links:
                continue
            value = re.sub(r"\b[A-Z_]+\b(?![^`]*`\B)", lambda found: f"[{found[0]}](#{links[found[0]]})" if found[0] in links else found[0], value)
            before = told.setdefault(meaning, (anchor, path)) if len(meaning.split()) > 8 else (anchor, path)
            if before != (anchor, path):
                meaning = f"As {'' if before[0] == anchor else f'[above](#{before[0]}) '}`{before[1]}`."
            else:
                meaning = escaped(meaning)
            text += f"| `{path}` | {value}{', optional' if optional else ''} | {meaning} |\n"
    return text


class Messages:
    """The messages of the method protocol as tables with a line each."""

    def __init__(self):
        self.of = json.loads((FORMATS / "host_message.schema.json").read_text())["definitions"]

    def members(self, node):
        said = []
        for name, one in node.get("properties", {}).items():
            if "description" in one or "$ref" in one:  # type and how stand in columns of their own
                refers = one.get("items", one).get("$ref", "").rpartition("/")[2]
                refers = f"{'list of ' if 'items' in one else ''}{refers.upper()}" if refers not in ("", "arrays", "action_space") else ""
                value = ", ".join(filter(None, [refers, one.get("description", "")]))
                words = f" ({', '.join(f'`{word}`' for word in one['enum'])})" if "enum" in one else ""
                said.append(f"`{name}`{'' if name in node['required'] else ', optional'}: {value}{words}")
        return "; ".join(said)

    def message(self, name):
        """`type`, when it comes, with its members; its payload."""
        node = self.of[name]
        head = ", ".join(filter(None, [f"`{node['properties']['type']['const']}`", node["description"]]))
        payload = f"payload: {node['x-payload']}" if "x-payload" in node else ""
        return " with ".join(filter(None, [head, "; ".join(filter(None, [self.members(node), payload]))]))

    def table(self, which):
        if which in ("action_space", "arrays"):
            rows = [f"| `{name}` | {one['description']} |" for name, one in self.of[which]["properties"].items()]
            return [f"| {'array' if which == 'arrays' else 'member of `action`'} | what |", "| --- | --- |", *rows]
        if which == "values":
            plain = [name for name, node in self.of.items() if "x-kind" not in node and name not in ("action_space", "array", "arrays")]
            return ["| value | JSON |", "| --- | --- |", *(
                f"| {name.upper()} | {': '.join(filter(None, [self.of[name]['description'], name != 'selection' and self.members(self.of[name])]))} |" for name in plain)]
        rows = []
        for node in (node for node in self.of.values() if node.get("x-kind") == which):
            kind, how = node["properties"]["type"]["const"], node["properties"].get("how", {})
            words = ", ".join(f"`{word}`" for word in how.get("enum", [how.get("const")]) if word) or "–"
            first = [f"`{kind}`", words] if which == "question" else [", ".join(filter(None, [f"`{kind}`", node["description"]]))]
            last = [] if which == "question" else [node.get("x-file", "")]
            rows.append("| " + " | ".join([*first, self.members(node) or "–", *last, self.message(node["x-reply"])]) + " |")
        if which == "question":
            return ["| `type` | `how` | members | the worker's answer |", "| --- | --- | --- | --- |", *rows]
        return ["| `type` | members | file | your reply |", "| --- | --- | --- | --- |", *rows]

    def filled(self, page):
        return re.sub(r"(<!-- messages:(\w+) -->\n).*?(<!-- /messages -->)",
                      lambda found: "\n".join([found[1], *self.table(found[2]), "", found[3]]), page, flags=re.S)


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else FORMATS)
    for name, (title, schemas) in PAGES.items():
        (out / f"{name}.md").write_text(page(title, schemas))
    (out / "method-protocol.md").write_text(Messages().filled((FORMATS / "method-protocol.md").read_text()))


if __name__ == "__main__":
    main()
