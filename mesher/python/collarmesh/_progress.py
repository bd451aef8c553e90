"""A progress bar on standard error."""

import contextlib
import shutil
import sys
from typing import Callable, Iterator, Optional, Union

Told = Callable[[str, float], Optional[bool]]


@contextlib.contextmanager
def watching(progress: Union[bool, Told, None]) -> Iterator[Optional[Told]]:
    """Gives the callable for the compiled part. For True, this draws a bar, whose line ends with the context."""
    if progress is not True:
        yield progress or None
        return
    try:
        yield _bar
    finally:
        print(file=sys.stderr)


def _bar(stage: str, fraction: float) -> None:
    width = max(10, min(60, shutil.get_terminal_size().columns - 25))
    done = round(width * fraction)
    print(f"\r{'#' * done}{'.' * (width - done)} {100 * fraction:3.0f} % {stage:<12}", end="", file=sys.stderr,
          flush=True)
