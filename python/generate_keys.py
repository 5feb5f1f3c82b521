"""Writes ``snapload/_keys.py``: the keys of a case and the ends of a run as Python's types, as the engine has them.

Run ``python python/generate_keys.py`` after a key or a stop rule was added; a test fails where that was forgotten.
"""

from pathlib import Path
from textwrap import fill

from snapload import _engine

TARGET = Path(__file__).parent / "snapload" / "_keys.py"

HEAD = '''"""Keys of a case, ends of a run. Written by ``generate_keys.py`` from the engine; do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypedDict, get_args

from numpy.typing import ArrayLike

'''


def type_of(key: dict) -> str:
    if key["words"]:
        return f"Literal[{', '.join(repr(word) for word in key['words'])}]".replace("'", '"')
    return key["kind"]


def optional_type_of(key: dict) -> str:
    return type_of(key) + (" | None" if may_be_none(key) else "")


def may_be_none(key: dict) -> bool:
    """The natural inertia, the missing one of a point mass, and the absence of a limit are given as None."""
    return key["name"] == "inertia" or key["standard"] is None


def python_literals(text: str) -> str:
    """Text of the engine with the values as Python writes them."""
    return text.replace("true", "True").replace("false", "False")


def unit_of(key: dict) -> str:
    return f" [{key['unit']}]" if key["unit"] not in ("", "1") else ""


def tuple_items(names: str) -> str:
    """Names with a comma and a space after each, as the contents of a tuple."""
    return names.removesuffix(" ") if names.count(",") == 1 else names.removesuffix(", ")


def end_types() -> str:
    """Why a run ends, as a type and as names."""
    stops = _engine.stops()
    reasons = "".join(f'    "{name}",\n' for name, _ in stops)
    limits = {name: meaning for name, meaning in stops if meaning is not None}
    names = "".join(f'"{name}", ' for name in limits)
    fields = "".join(f"    {name}: float | None = None\n" for name in limits)
    lines = "".join(f"    {name} : float, optional\n        The run ends where {limits[name]}.\n" for name in limits)
    return f"""#: Why a run ends.
Reason = Literal[
{reasons}]

#: The same as names.
REASONS: tuple[Reason, ...] = get_args(Reason)

#: Those of them that are limits of the motion.
LIMITS: tuple[Reason, ...] = ({tuple_items(names)})


@dataclass(frozen=True, kw_only=True, repr=False)
class LimitBounds:
    \"\"\"The bounds of the limits of the motion; none of one that ends no run.\"\"\"

{fields}

#: The same as a section of a docstring.
LIMIT_PARAMETERS = \"\"\"
{lines.rstrip()}
\"\"\"

"""


def generate() -> str:
    keys = _engine.keys()
    text = HEAD + end_types()
    optional = "".join(f'"{key["name"]}", ' for key in keys if may_be_none(key))
    text += f"#: Keys that None takes back to what holds without them.\nOPTIONAL = ({tuple_items(optional)})\n\n\n"
    text += 'class Keys(TypedDict, total=False):\n    """The keys that a case takes."""\n\n'
    text += "".join(f"    {key['name']}: {optional_type_of(key)}\n" for key in keys)
    text += '\n\nclass Axes(TypedDict, total=False):\n    """The keys that a study varies."""\n\n'
    text += "".join(f"    {key['name']}: ArrayLike\n" for key in keys)
    text += '\n\nclass KeyValues:\n    """The keys of a case as properties."""\n\n'
    text += "    def keys(self) -> dict[str, Any]:\n"
    text += '        """Every key in effect with its value."""\n        raise NotImplementedError\n'
    for key in keys:
        kind = optional_type_of(key)
        text += f"""
    @property
    def {key["name"]}(self) -> {kind}:
        \"\"\"{key["meaning"][0].upper()}{key["meaning"][1:]}{unit_of(key)}.\"\"\"
        value: {kind} = self.keys()["{key["name"]}"]
        return value
"""
    text += '\n\n#: The keys as a section of a docstring.\nPARAMETERS = """'
    for key in keys:
        kind = "{" + ", ".join(f'"{word}"' for word in key["words"]) + "}" if key["words"] else key["kind"]
        about = f"{key['meaning'][0].upper()}{key['meaning'][1:]}{unit_of(key)}; "
        about += f"allowed: ``{python_literals(key['allowed'])}``; "
        about = fill(
            f"{about}default {python_literals(key['default'])}.",
            112,
            initial_indent=" " * 8,
            subsequent_indent=" " * 8,
        )
        text += f"\n    {key['name']} : {kind}, optional\n{about}"
    return text + '\n"""\n'


if __name__ == "__main__":
    TARGET.write_text(generate(), encoding="utf-8")
