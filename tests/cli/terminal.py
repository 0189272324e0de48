"""A pseudo-terminal: the command as it runs before a user's eyes, Ctrl-C included."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
from pathlib import Path

from .runs import COMMAND, REPOSITORY, empty_cache

CTRL_C = b"\x03"
_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


class Terminal:
    """The command with a terminal of its own as stdin, stdout and stderr."""

    def __init__(self, *arguments: str | Path) -> None:
        self._leader, follower = pty.openpty()
        fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        self.process = subprocess.Popen(
            [*COMMAND, *map(str, arguments)],
            stdin=follower,
            stdout=follower,
            stderr=follower,
            cwd=REPOSITORY,
            env={**os.environ, "TERM": "xterm", "XDG_CACHE_HOME": empty_cache()},
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
        )
        os.close(follower)
        self._shown = ""

    @property
    def shown(self) -> str:
        """Everything shown so far, without colours and cursor movements."""
        return _ESCAPE.sub("", self._shown)

    def wait_for(self, pattern: str, timeout: float = 600.0) -> bool:
        """Read until the pattern is shown; False if the command ends without."""
        limit = time.monotonic() + timeout
        while re.search(pattern, self.shown) is None:
            if time.monotonic() > limit:
                raise TimeoutError(self.shown)
            if not self._read():
                return False
        return True

    def press(self, keys: bytes) -> None:
        """Type something."""
        os.write(self._leader, keys)

    def finish(self, timeout: float = 600.0) -> int:
        """Read until the command ends; give its exit code."""
        limit = time.monotonic() + timeout
        while self._read():
            if time.monotonic() > limit:
                raise TimeoutError(self.shown)
        os.close(self._leader)
        return self.process.wait(timeout=10)

    def _read(self) -> bool:
        """Read a piece; False at the end."""
        if not select.select([self._leader], [], [], 1.0)[0]:
            return True
        try:
            piece = os.read(self._leader, 65536)
        except OSError:
            return False
        self._shown += piece.decode(errors="replace")
        return bool(piece)
