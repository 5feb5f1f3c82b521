"""Writes LICENSE-THIRD-PARTY: the licences of all libraries in the wheel and the program, with their texts.

``python3 release/third_party.py`` writes it to the root of the repository, where the wheel and the archives take it
from; ``--check`` only looks whether every licence is one that deny.toml allows.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "LICENSE-THIRD-PARTY"
#: What ends up in what is published.
PUBLISHED = ("snapload-python", "snapload-cli")
#: Files that hold the words of a licence.
TEXTS = re.compile(r"^(licen[cs]e|copying|unlicense|notice|copyright)", re.IGNORECASE)


def libraries() -> list[dict]:
    """All libraries that are linked into what is published, by name and version."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    about = json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout)
    packages = {package["id"]: package for package in about["packages"]}
    nodes = {node["id"]: node for node in about["resolve"]["nodes"]}
    pending = [key for key, package in packages.items() if package["name"] in PUBLISHED]
    seen: set[str] = set()
    while pending:
        key = pending.pop()
        if key in seen:
            continue
        seen.add(key)
        for dependency in nodes[key]["deps"]:
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                pending.append(dependency["pkg"])
    linked = [packages[key] for key in seen if packages[key]["source"] is not None]
    return sorted(linked, key=lambda package: (package["name"], package["version"]))


def permitted(expression: str, allowed: set[str]) -> bool:
    """Whether a licence expression can be kept with the licences allowed."""
    tokens = re.findall(r"\(|\)|[^\s()/]+|/", expression.replace(" WITH ", "~WITH~"))

    def any_of() -> bool:
        result = all_of()
        while tokens and tokens[0] in ("OR", "/"):
            tokens.pop(0)
            result = all_of() or result
        return result

    def all_of() -> bool:
        result = single()
        while tokens and tokens[0] == "AND":
            tokens.pop(0)
            result = single() and result
        return result

    def single() -> bool:
        token = tokens.pop(0)
        if token != "(":
            return token.replace("~WITH~", " WITH ") in allowed
        result = any_of()
        tokens.pop(0)
        return result

    return any_of()


def licence_texts(package: dict) -> dict[str, str]:
    """The files with the words of its licences."""
    folder = Path(package["manifest_path"]).parent
    found = [file for file in sorted(folder.iterdir()) if file.is_file() and TEXTS.match(file.name)]
    return {file.name: file.read_text(encoding="utf-8", errors="replace").strip() for file in found}


def main() -> None:
    allowed = set(tomllib.loads((ROOT / "deny.toml").read_text())["licenses"]["allow"])
    linked = libraries()
    wrong = [
        f"{p['name']} {p['version']}: {p['license']}" for p in linked if not permitted(p["license"] or "", allowed)
    ]
    if wrong:
        sys.exit("licences that deny.toml does not allow:\n  " + "\n  ".join(wrong))
    # Many libraries have the same text, which stands once.
    by_text: dict[str, list[str]] = {}
    for file in sorted(ROOT.glob("crates/*/assets/LICENSE*")):
        by_text[file.read_text(encoding="utf-8").strip()] = [f"the letters in pictures ({file.name})"]
    without = []
    for package in linked:
        name = f"{package['name']} {package['version']}"
        found = licence_texts(package)
        if not found:
            without.append(f"{name}: {package['license']}, {package['repository']}")
        for text in found.values():
            by_text.setdefault(text, []).append(name)
    if "--check" in sys.argv:
        print(f"{len(linked)} libraries, all under licences that deny.toml allows")
        return
    parts = [
        f"snapload is linked with {len(linked)} libraries, each under a licence of its own.",
        "\n".join(f"{p['name']} {p['version']}: {p['license']}" for p in linked),
    ]
    if without:
        parts.append("Without a text in their sources, under the licence named:\n" + "\n".join(without))
    parts += ["The licence of " + ", ".join(dict.fromkeys(names)) + ":\n\n" + text for text, names in by_text.items()]
    TARGET.write_text(f"\n\n{'=' * 100}\n\n".join(parts) + "\n", encoding="utf-8")
    print(f"{TARGET.name}: {len(linked)} libraries, {len(by_text)} texts, {len(without)} without one")


if __name__ == "__main__":
    main()
