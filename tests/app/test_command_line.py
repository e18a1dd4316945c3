"""``gc-teach`` itself: what its help and its mistakes say."""

from __future__ import annotations

import pytest

from app.__main__ import COMMANDS, main


def said(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    with pytest.raises(SystemExit):
        main(words)
    told = capsys.readouterr()
    return " ".join((told.out + told.err).split())


@pytest.mark.parametrize("word", ["frobnicate", "--help"])
def test_every_command_is_named(word: str, capsys: pytest.CaptureFixture[str]) -> None:
    told = said(capsys, word)

    assert all(name in told for name in (*(command.__name__ for command in COMMANDS), "skills"))
    assert "(required)" not in told


@pytest.mark.parametrize("command", [command.__name__ for command in COMMANDS])
def test_help_is_written_for_people(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    told = said(capsys, command, "--help")

    assert "None" not in told
    assert "*" not in told
