"""Every question of the engine is a verb of the command, and answers the same there, in Python and on the page."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from pathlib import Path

import pytest
import snapload
from playwright.sync_api import expect
from snapload import _engine

DOCS = Path(__file__).parents[2] / "docs"
VALUES = {"f_o": 0.31, "t_end": 2}


def post(url: str, name: str, **request) -> bytes:
    """The answer of the page's server."""
    body = json.dumps(request).encode()
    headers = {"Content-Type": "application/json"}
    with urllib.request.urlopen(urllib.request.Request(f"{url}api/question/{name}", body, headers)) as answer:
        return answer.read()


def refused(url: str, name: str, **request) -> dict:
    with pytest.raises(urllib.error.HTTPError) as error:
        post(url, name, **request)
    return json.loads(error.value.read())


@pytest.fixture(scope="module")
def questions(url) -> list[dict]:
    with urllib.request.urlopen(f"{url}api/schema") as answer:
        return json.loads(answer.read())["questions"]


def test_every_question_has_the_same_answer_everywhere(questions, url, command):
    assert {"verify", "sensitivities"} <= {question["name"] for question in questions}
    case = snapload.Case(**VALUES)
    settings = [word for key, value in VALUES.items() for word in ("--set", f"{key}={value}")]
    for question in questions:
        name = question["name"]
        python = _engine.answer(name, case._engine, {}, None)
        line = command(name, *settings, "--json", "-").rstrip("\n")
        # Not only equal: the same text of every number.
        assert python.endswith(f'"answer":{line}}}')
        page = post(url, name, values=VALUES).decode()
        assert page.endswith(f'"answer":{line}}}')
        text = command(name, *settings)
        assert json.loads(python)["words"] == text
        assert text == f"Case      {text.splitlines()[0][10:]}\n{json.loads(page)['words']}"


def test_every_question_is_a_verb_with_its_options(questions, url, command):
    # Lines are broken where the terminal ends.
    listed = " ".join(command("--help").split())
    completions = command("completions", "fish")
    for question in questions:
        name = question["name"]
        assert f" {name} {question['asks']} " in listed
        assert f'-n "__fish_snapload_using_subcommand {name}"' in completions
        help = command(name, "--help")
        assert question["asks"] in " ".join(help.split()) and "Examples:" in help
        for option in question["options"]:
            written = "--" + option["name"].replace("_", "-")
            assert f"  {written} " in help
            if option["kind"]["type"] in ("number", "count"):
                message = command(name, written, "x", fails=True)
                assert message.startswith(f"error: {written} = x is not allowed; allowed: a ")
                page = refused(url, name, options={option["name"]: "x"})
                assert page["key"] == option["name"]
                assert page["message"] == f'{option["name"]} = "x" is not allowed; allowed: {option["allowed"]}'
                with pytest.raises(ValueError, match=f'{option["name"]} = "x" is not allowed; allowed: '):
                    _engine.answer(name, snapload.Case()._engine, {option["name"]: "x"}, None)


def test_every_question_is_a_function_that_the_manual_knows(questions):
    pages = {file: (DOCS / file).read_text(encoding="utf-8") for file in ("api.md", "python.md", "cases.md")}
    for question in questions:
        name = question["name"]
        assert name in snapload.__all__ and callable(getattr(snapload, name))
        assert f"\n.. autofunction:: {name}\n" in pages["api.md"] and f"`snapload.{name}(" in pages["python.md"]
        assert f"`snapload {name}`" in pages["cases.md"]


def test_unknown_questions_and_options_are_refused(url):
    assert refused(url, "verify", options={"digit": 60})["key"] == "digit"
    assert "did you mean digits?" in refused(url, "verify", options={"digit": 60})["message"]
    assert refused(url, "verify", values={"e": 2})["key"] == "e"
    assert refused(url, "nothing")["message"] == "there is nothing at this path"
    with pytest.raises(ValueError, match='there is no key "digit".*; did you mean digits'):
        _engine.answer("verify", snapload.Case()._engine, {"digit": 60}, None)


def test_the_page_asks_every_question(questions, open_page, command):
    page = open_page("f_o=0.31&t=0")
    page.locator("#question-box summary").click()
    for question in questions:
        page.locator("#question").select_option(question["name"])
        expect(page.locator("#question-words")).to_be_hidden()
        page.locator("#question-ask").click()
        expect(page.locator("#question-words")).to_be_visible(timeout=20_000)
        text = command(question["name"], "--set", "f_o=0.31").split("\n", 1)[1].rstrip()
        assert page.locator("#question-words").inner_text() == text
    page.locator("#question").select_option("verify")
    page.locator("#question-tolerance").fill("1e-30")
    page.locator("#question-ask").click()
    expect(page.locator("#question-words")).to_contain_text("wrong by more than 1e-30 from impact 1 on")


def test_the_page_reports_a_wrong_option(open_page):
    page = open_page("f_o=0.31&t=0", refused=1)
    page.locator("#question-box summary").click()
    page.locator("#question-digits").fill("many")
    page.locator("#question-ask").click()
    message = 'digits = "many" is not allowed; allowed: a whole number, 1 <= digits <= 307'
    expect(page.locator("#question-message")).to_have_text(message)


@pytest.mark.parametrize(
    "option", [dict(uncertainty=1e-6), dict(tolerance=1e-13), dict(tolerance=float("nan")), dict(seed=2)]
)
def test_what_only_neighbours_have_is_refused_where_none_are_run(option):
    (name,) = option
    with pytest.raises(ValueError, match=f"^{name} needs neighbours, but none are run; give members"):
        snapload.critical_force(snapload.Case(), **option)
    with pytest.raises(ValueError, match=f"^over runs no neighbours; leave out members and {name}, or over"):
        snapload.critical_force(snapload.Case(), over={"e": [0.5]}, members=2, **option)
    assert snapload.critical_force(snapload.Case(), largest=0.1, tolerance=1e-3, seed=1).f_cr is None


def test_an_answer_belongs_to_the_values_that_were_asked_about(open_page):
    page = open_page("f_o=0.31&t=0", refused=1)
    page.locator("#question-box summary").click()
    page.locator("#question").select_option("sensitivities")
    # A run that the page refuses, perhaps for its time, can be asked about.
    page.route("**/api/run", lambda route: route.fulfill(status=400, json={"message": "this takes too long"}))
    page.locator("#field-f_o").fill("0.32")
    expect(page.locator("#failed")).to_contain_text("this takes too long")
    page.unroute("**/api/run")
    page.locator("#question-ask").click()
    expect(page.locator("#question-words")).to_be_visible(timeout=20_000)
    page.locator("#field-f_o").fill("0.31")
    expect(page.locator("#failed")).to_be_hidden()
    expect(page.locator("#question-words")).to_be_hidden()
    # Its options are written as all numbers of the page are.
    page.locator("#question-impacts").fill("0x10")
    page.locator("#question-ask").click()
    expect(page.locator("#question-message")).to_contain_text("0x10")
