"""docs/parameters.md names everything that can be asked of a run, with the defaults that it has."""

import ast
import dataclasses
import inspect

import hybrid_quad
from hybrid_quad.cli.main import _parser
from hybrid_quad.core.options import RemeshOptions
from support.doc_tables import parameter_rows, quoted

NOT_WISHES = {"vertices", "faces", "progress", "cancel", "cache", "dump_stages", "on_snapshot"}


def test_every_option_has_a_row_with_its_default(root):
    rows = {quoted(row["Python"])[0]: row for row in parameter_rows(root) if "Default" in row}
    fields = {field.name: field.default for field in dataclasses.fields(RemeshOptions)}
    assert rows.keys() == fields.keys()
    for name, default in fields.items():
        told = ast.literal_eval(quoted(rows[name]["Default"])[0])
        assert (told, type(told)) == (default, type(default)), name
        assert rows[name]["Unit"] and rows[name]["What it does"]


def test_what_is_asked_of_places_has_rows_too(root):
    rows = {quoted(row["Python"])[0] for row in parameter_rows(root)}
    assert rows == inspect.signature(hybrid_quad.remesh).parameters.keys() - NOT_WISHES


def test_flags_are_those_of_the_command_with_the_same_defaults(root):
    asked = vars(_parser().parse_args(["remesh", "in.obj", "out.obj"]))
    told = {flag for row in parameter_rows(root) for flag in quoted(row["Command"])}
    for flag in told:
        assert flag.removeprefix("--").replace("-", "_") in asked, flag
    for name, value in asked.items():
        if name in {field.name for field in dataclasses.fields(RemeshOptions)} - {"quads"} and value is not None:
            assert value == getattr(RemeshOptions, name), name
    # Everything that says what is wanted, not where it is read, written and shown.
    others = {
        "input",
        "output",
        "run",
        "report",
        "picture",
        "dump_stages",
        "quiet",
        "end_with_stdin",
        "part",
        "odd_border",
    }
    assert {flag.removeprefix("--").replace("-", "_") for flag in told} == asked.keys() - others
