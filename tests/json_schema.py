"""As much of JSON Schema (draft 07) as the schemas of docs/formats use."""
import re

TYPES = {"object": dict, "array": list, "string": str, "number": (int, float), "integer": int, "boolean": bool, "null": type(None)}


def complaints(document, schema, root=None, place=""):
    """Where `document` is not as `schema` asks, a line each."""
    root = schema if root is None else root
    if "$ref" in schema:
        target = root
        for name in schema["$ref"].split("/")[1:]:
            target = target[name]
        return complaints(document, target, root, place)
    found = []

    def below(one, part, name):
        found.extend(complaints(one, part, root, f"{place}/{name}"))

    kinds = schema.get("type", list(TYPES))
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if not any(isinstance(document, TYPES[kind]) and isinstance(document, bool) <= (kind == "boolean") for kind in kinds):
        return [f"{place}: not {' or '.join(kinds)}"]
    if document not in schema.get("enum", [document]) or schema.get("const", document) != document:
        found.append(f"{place}: {document!r} is none of the values")
    if isinstance(document, dict):
        found += [f"{place}: no {name}" for name in schema.get("required", []) if name not in document]
        for name, one in document.items():
            parts = [part for pattern, part in schema.get("patternProperties", {}).items() if re.search(pattern, name)]
            if name in schema.get("properties", {}):
                parts.append(schema["properties"][name])
            for part in parts or [schema.get("additionalProperties", {})]:
                if part is False:
                    found.append(f"{place}: {name} is unknown")
                elif part is not True:
                    below(one, part, name)
    elif isinstance(document, list):
        if not schema.get("minItems", 0) <= len(document) <= schema.get("maxItems", len(document)):
            found.append(f"{place}: {len(document)} elements")
        for i, one in enumerate(document):
            below(one, schema.get("items", {}), i)
    elif isinstance(document, str):
        if not re.search(schema.get("pattern", ""), document):
            found.append(f"{place}: {document!r} does not match")
    elif isinstance(document, (int, float)):
        if not schema.get("minimum", document) <= document <= schema.get("maximum", document):
            found.append(f"{place}: {document} is out of bounds")
    for key in "oneOf", "anyOf":
        fit = sum(not complaints(document, part, root, place) for part in schema.get(key, []))
        if key in schema and (fit == 0 or (key == "oneOf" and fit > 1)):
            found.append(f"{place}: fits {fit} of {key}")
    return found
