"""The command line, with which answers are compared."""

from __future__ import annotations

import os
import pathlib
import subprocess
from typing import Callable

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """Run the command line and return what it writes; INTERWELL names the program."""
    program = os.environ.get("INTERWELL")
    if program is None:
        pytest.skip("INTERWELL does not name the program to compare with")

    def run(*arguments: str) -> str:
        done = subprocess.run(
            [program, "--headless", *arguments, "--quiet"], capture_output=True, text=True, check=True
        )
        return done.stdout

    return run
