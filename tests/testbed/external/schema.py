"""As much of JSON Schema as docs/scene.schema.json uses."""

TYPES = {"object": dict, "array": list, "string": str, "integer": int, "number": (int, float), "null": type(None)}


def is_type(value, name):
    return isinstance(value, TYPES[name]) and not (name in ("integer", "number") and isinstance(value, bool))


def faults(value, schema, place="scene.json"):
    """What of the value is not as the schema says, each with its place."""
    unknown = set(schema) - {"$schema", "title", "description", "type", "const", "enum", "minimum", "required",
                             "properties", "additionalProperties", "items"}
    if unknown:
        raise ValueError(f"{place}: keywords that are not understood here: {unknown}")
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    if types and not any(is_type(value, name) for name in types):
        yield f"{place}: {value!r} is no {' or '.join(types)}"
        return
    if "const" in schema and value != schema["const"]:
        yield f"{place}: {value!r} is not {schema['const']!r}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{place}: {value!r} is none of {schema['enum']}"
    if "minimum" in schema and value < schema["minimum"]:
        yield f"{place}: {value!r} is less than {schema['minimum']}"
    if isinstance(value, dict):
        yield from faults_of_object(value, schema, place)
    if isinstance(value, list) and "items" in schema:
        for i, item in enumerate(value):
            yield from faults(item, schema["items"], f"{place}[{i}]")


def faults_of_object(value, schema, place):
    for key in schema.get("required", []):
        if key not in value:
            yield f"{place}: has no {key}"
    known = schema.get("properties", {})
    rest = schema.get("additionalProperties", True)
    for key, item in value.items():
        if key in known:
            yield from faults(item, known[key], f"{place}.{key}")
        elif rest is False:
            yield f"{place}: {key} is not in the schema"
        elif isinstance(rest, dict):
            yield from faults(item, rest, f"{place}.{key}")
