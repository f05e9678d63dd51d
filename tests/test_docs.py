"""Every command and every option is explained: in its help, with an example, and in the README."""

from __future__ import annotations

import re
from pathlib import Path

import click
import pytest

from geomdrap.cli import COMMANDS, cli
from geomdrap.export.outputs import OUTPUTS

README = Path(__file__).parents[1] / "README.md"
CONTEXT = click.Context(cli, info_name="geomdrap", **cli.context_settings)


def _command(name: str) -> click.Command:
    first, *more = name.split()
    command = cli.get_command(CONTEXT, first)
    for word in more:
        assert isinstance(command, click.Group)
        command = command.get_command(CONTEXT, word)
    assert command is not None
    return command


def _leaves() -> list[str]:
    """Names of all commands, those of groups with the group's name before."""
    groups = {name: command for name in COMMANDS if isinstance(command := _command(name), click.Group)}
    inner = [f"{name} {sub}" for name, group in groups.items() for sub in group.commands]
    return [name for name in COMMANDS if name not in groups] + inner


LEAVES = _leaves()


def _options(command: click.Command) -> list[click.Option]:
    return [parameter for parameter in command.params if isinstance(parameter, click.Option)]


@pytest.mark.parametrize("name", LEAVES)
def test_a_command_has_help_that_says_what_it_does(name: str) -> None:
    text = _command(name).help or ""
    assert len(text.splitlines()[0]) > 20
    assert text.splitlines()[0].endswith(".")


@pytest.mark.parametrize("name", LEAVES)
def test_the_help_of_a_command_has_an_example_of_it_that_parses(name: str) -> None:
    text = _command(name).get_help(click.Context(_command(name), CONTEXT, name))
    examples = re.findall(rf"^ *geomdrap {name} (.+)$", text, flags=re.MULTILINE)
    assert examples, f"the help of {name} has no example"
    for example in examples:
        _command(name).make_context(name, example.split(), CONTEXT)  # raises UsageError if it does not parse


@pytest.mark.parametrize("name", LEAVES)
def test_every_option_has_help(name: str) -> None:
    silent = [option.opts[0] for option in _options(_command(name)) if not option.help]
    assert not silent


@pytest.mark.parametrize("name", LEAVES)
def test_every_command_prints_json(name: str) -> None:
    assert "--json" in [opt for option in _options(_command(name)) for opt in option.opts]


@pytest.mark.parametrize("name", LEAVES)
def test_help_comes_with_a_short_and_a_long_option(name: str) -> None:
    for flag in ("-h", "--help"):
        with pytest.raises(SystemExit) as end:
            cli.main([*name.split(), flag])
        assert end.value.code == 0


@pytest.mark.parametrize("name", LEAVES)
def test_the_readme_names_the_command_and_all_its_options(name: str) -> None:
    text = README.read_text(encoding="utf-8")
    wanted = [f"geomdrap {name}", *(max(o.opts, key=len) for o in _options(_command(name)))]
    missing = [word for word in wanted if not re.search(re.escape(word) + r"(?![\w-])", text)]
    assert not missing, f"README.md does not mention {', '.join(missing)} of geomdrap {name}"


def test_the_list_of_outputs_on_the_command_line_is_the_list_of_formats() -> None:
    from geomdrap.cli.options import OUTPUTS as OFFERED

    assert tuple(OUTPUTS) == OFFERED


def test_what_is_written_by_default_is_the_same_on_the_command_line_and_in_python() -> None:
    from geomdrap.cli.options import USUAL as OFFERED
    from geomdrap.export.outputs import USUAL

    assert USUAL == OFFERED


@pytest.mark.parametrize("name", [output.file for outputs in OUTPUTS.values() for output in outputs])
def test_the_readme_names_every_result_file(name: str) -> None:
    assert name in README.read_text(encoding="utf-8")
