"""Options of a command that are declared elsewhere: in the registries of formats and targets, or once for several commands."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from typing import Any, Optional

import typer

from ..options import FormatOption

Command = Callable[..., Any]


def asking(*groups: tuple[str, Iterable[FormatOption]]) -> Callable[[Command], Command]:
    """Add options to a command, which gets those that were given as a dict.

    groups: (the keyword that the command takes the dict by, the options).  An option that two groups have is asked once and
    handed to both.
    """

    def decorate(command: Command) -> Command:
        listed = {keyword: {option.name: option for option in options} for keyword, options in groups}
        known = {name: option for options in listed.values() for name, option in options.items()}

        def asked(**given: Any) -> Any:
            values = {name: given.pop(name) for name in known}
            stated = {name: value for name, value in values.items() if value not in (None, [], False)}
            split = {
                keyword: {name: value for name, value in stated.items() if name in options}
                for keyword, options in listed.items()
            }
            return command(**given, **split)

        own = inspect.signature(command, eval_str=True)
        kept = [parameter for name, parameter in own.parameters.items() if name not in listed]
        return _shown_as(asked, command, [*kept, *map(_parameter, known.values())])

    return decorate


def taking(keyword: str, maker: Command) -> Callable[[Command], Command]:
    """Add a function's parameters to a command, which gets by ``keyword`` what the function makes of their values."""

    def decorate(command: Command) -> Command:
        names = inspect.signature(maker).parameters

        def asked(**given: Any) -> Any:
            made = maker(**{name: given.pop(name) for name in names})
            return command(**given, **{keyword: made})

        own = inspect.signature(command, eval_str=True).parameters
        kept = [parameter for name, parameter in own.items() if name != keyword]
        added = inspect.signature(maker, eval_str=True).parameters.values()
        return _shown_as(asked, command, [*kept, *added])

    return decorate


def _shown_as(asked: Command, command: Command, parameters: list[inspect.Parameter]) -> Command:
    """What typer is to see: the command's own words over these parameters."""
    keywords = [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in parameters]
    asked.__signature__ = inspect.Signature(keywords)  # type: ignore[attr-defined]
    asked.__annotations__ = {parameter.name: parameter.annotation for parameter in keywords}
    asked.__name__, asked.__doc__ = command.__name__, command.__doc__
    return asked


def _parameter(option: FormatOption) -> inspect.Parameter:
    kind: Any = option.kind
    annotation: Any = list[kind] if option.repeated else kind if option.kind is bool else Optional[kind]
    flag = f"--{option.name.replace('_', '-')}"
    default: Any = False if option.kind is bool else [] if option.repeated else None
    declared = typer.Option(
        default,
        flag,
        help=option.help,
        show_default=False,
        metavar=option.metavar or "|".join(option.words) or None,
        callback=_checked(option) if option.words else None,
        autocompletion=_beginning(option.words) if option.words else None,
    )
    return inspect.Parameter(
        option.name, inspect.Parameter.KEYWORD_ONLY, default=declared, annotation=annotation
    )


def _beginning(words: tuple[str, ...]) -> Callable[[str], list[str]]:
    """The words that a shell offers."""

    def complete(incomplete: str) -> list[str]:
        return [word for word in words if word.startswith(incomplete)]

    return complete


def _checked(option: FormatOption) -> Callable[[Any], Any]:
    def check(value: Any) -> Any:
        for word in value if option.repeated else [value]:
            if word is not None and word not in option.words:
                raise typer.BadParameter(f"{word!r} is not one of {', '.join(option.words)}")
        return value

    return check
