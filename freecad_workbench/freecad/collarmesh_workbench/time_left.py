"""How long a run will go on, from how far it is and how long it has taken."""

LEAST_SECONDS, LEAST_SHARE = 2, 0.13  # before these, nobody can know from the run itself

# What share of the time has gone by where the program says that it is this far: rounded means over seven runs that
# made from 2,500 to 225,000 elements.
_SHARES = ((0, 0), (0.08, 0.1), (0.131, 0.13), (0.59, 0.3), (0.675, 0.7), (0.76, 0.88), (0.811, 0.91),
           (0.93, 0.97), (1, 1))


def share_of_time(fraction):
    """0 to 1; `fraction` is the program's."""
    for (f0, s0), (f1, s1) in zip(_SHARES, _SHARES[1:]):
        if fraction <= f1:
            return s0 + (s1 - s0) * max(0, fraction - f0) / (f1 - f0)
    return 1


class TimeLeft:
    """Of one run. While the program stays where it is, time goes by."""

    def __init__(self):
        self._fraction = self._end = None

    def seconds(self, passed, fraction, predicted=None):
        """None where nobody can know. `passed`: since the start; `predicted`: for the whole run, before it began."""
        share = share_of_time(fraction)
        if passed >= LEAST_SECONDS and share >= LEAST_SHARE:
            if self._fraction is None or fraction > self._fraction:
                self._fraction, self._end = fraction, passed / share
        elif predicted is not None:
            self._end = predicted
        return self._end - passed if self._end is not None and self._end > passed else None
