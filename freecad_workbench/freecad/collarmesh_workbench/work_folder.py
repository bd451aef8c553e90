"""A temporary folder that is removed however the process that made it ends.
A shell holds the end of a pipe to this process. The pipe closes on `cleanup`, or when this process ends or is
killed. Then the shell kills the program that worked in the folder, and removes the folder."""

import contextlib
import subprocess
import tempfile

_WATCH = """
trap '' INT TERM HUP
program=
while read -r line; do program=$line; done
[ -n "$program" ] && kill -KILL "$program"
for attempt in 1 2 3 4 5 6 7 8 9 10; do
  rm -rf "$1"
  [ -e "$1" ] || exit 0
  sleep 0.2
done
"""


class WorkFolder:
    """Like `tempfile.TemporaryDirectory`, for a folder in which a program works."""

    def __init__(self):
        self.name = tempfile.mkdtemp(prefix="collarmesh-")
        self._watcher = subprocess.Popen(
            ["/bin/sh", "-c", _WATCH, "collarmesh-watch", self.name], stdin=subprocess.PIPE, text=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)

    def program_is(self, process_id):
        """Sets the process that works in the folder; None: it has ended."""
        with contextlib.suppress(OSError, ValueError):
            self._watcher.stdin.write(f"{process_id or ''}\n")
            self._watcher.stdin.flush()

    def cleanup(self):
        """Ends the program, if there is one, and removes the folder."""
        with contextlib.suppress(OSError, ValueError):
            self._watcher.stdin.close()
        self._watcher.wait()
