# SPDX-License-Identifier: Apache-2.0
"""How the commands of scaleaxis-batch end."""

from __future__ import annotations

import argparse
from typing import Any, NoReturn

DONE, FAILED, USAGE, CANCELLED = 0, 1, 2, 5  # as of the program scaleaxis


class Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """One line; --help has the rest."""
        self.exit(USAGE, f"{self.prog}: {message}\n")


def stop(*_: Any) -> NoReturn:
    """For signals: as Ctrl-C."""
    raise KeyboardInterrupt
