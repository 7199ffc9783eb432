"""Changes of what JSON, YAML and TOML files hold: values, keys and their places."""

import copy
import functools
import itertools
import json
import tomllib

import tomli_w
import yaml

from fuzz import hostile

MOST_NODES = 50_000  # aliases can make a tree endless


def nodes(tree):
    """Yield (parent, key) of every value of a tree."""
    pairs = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in pairs:
        yield tree, key
        if isinstance(value, dict | list):
            yield from nodes(value)


def put(parent, key, _there, rng):
    """Put a hostile value there."""
    parent[key] = hostile.value(rng)


def drop(parent, key, _there, _rng):
    """Delete an entry."""
    del parent[key]


def rename(parent, key, there, rng):
    """Rename a key; in a list, repeat an entry."""
    if isinstance(parent, list):
        parent.insert(rng.randrange(len(parent) + 1), parent[key])
        return
    keys = [k for _, k in there if isinstance(k, str)]
    new = rng.choice([rng.choice(hostile.NAMES), rng.choice(keys), str(key).upper(), f"{key}x"])
    parent[new] = parent.pop(key)


def exchange(parent, key, there, rng):
    """Put a copy of another value there."""
    other, other_key = rng.choice(there)
    parent[key] = copy.deepcopy(other[other_key])


def wrap(parent, key, _there, rng):
    """Put the value into a list or a mapping, or take its text."""
    value = parent[key]
    parent[key] = rng.choice([[value], {"x": value}, str(value), [value, value]])


WAYS = (put, put, put, drop, rename, exchange, wrap)


def changed(tree, rng):
    """Return a tree with one to three changes."""
    tree = copy.deepcopy(tree)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        there = nodes(tree) if isinstance(tree, dict | list) else ()
        there = list(itertools.islice(there, MOST_NODES))
        if len(there) == MOST_NODES:
            raise ValueError("too large a tree")
        if not there or rng.random() < 0.02:
            return hostile.value(rng)
        rng.choice(WAYS)(*rng.choice(there), there, rng)
    return tree


def _way(parse, write):
    parse = functools.lru_cache(maxsize=64)(parse)

    def change(data, rng):
        """Change the tree that a file holds; a file that holds none stays as it is."""
        try:
            return write(changed(parse(data), rng))
        except (ValueError, TypeError, AttributeError, RecursionError, yaml.YAMLError):
            return data

    return change


change_json = _way(json.loads, lambda tree: json.dumps(tree).encode())
change_yaml = _way(
    lambda data: yaml.safe_load(data.decode()),
    lambda tree: yaml.safe_dump(tree, sort_keys=False, allow_unicode=True).encode(),
)
change_toml = _way(
    lambda data: tomllib.loads(data.decode()), lambda tree: tomli_w.dumps(tree).encode()
)
