"""Estimates the remaining time of a run from its progress, its elapsed time, and its predicted time."""

import math

LEAST_SECONDS, LEAST_SHARE = 2, 0.13  # below these the run itself permits no estimate
GROWTH = 1.5  # an estimate that exceeds the smallest one shown by this factor is not shown

# The share of the time that has passed at each fraction that the program reports: rounded means over several
# runs.
_SHARES = ((0, 0), (0.08, 0.1), (0.131, 0.13), (0.59, 0.3), (0.675, 0.7), (0.76, 0.88), (0.811, 0.91),
           (0.93, 0.97), (1, 1))


def share_of_time(fraction):
    """Returns the share of the time, 0 to 1, that has passed at the program's `fraction`."""
    for (f0, s0), (f1, s1) in zip(_SHARES, _SHARES[1:]):
        if fraction <= f1:
            return s0 + (s1 - s0) * max(0, fraction - f0) / (f1 - f0)
    return 1


class TimeLeft:
    """An estimate of the remaining time of one run. `predicted` and `afterwards` are the predicted seconds of the
    program and of the steps after it; `predicted` is None without a prediction."""

    def __init__(self, predicted=None, afterwards=0):
        self._predicted, self._afterwards = predicted, afterwards
        self._fraction, self._end = -1, math.inf  # last fraction, and the total time that the run itself suggests
        self._least = math.inf  # smallest estimate shown

    def seconds(self, passed, fraction):
        """Returns the remaining seconds when `passed` seconds have passed. None: unknown. Infinite: the estimated time
        is over, or the estimate exceeds GROWTH times the smallest one that was shown."""
        share = share_of_time(fraction)
        left = self._by_run(passed, fraction, share) if self._predicted is None else self._by_prediction(passed, share)
        if left is None or left > GROWTH * self._least:
            return left if left is None else math.inf
        self._least = min(self._least, left)
        return left

    def _by_prediction(self, passed, share):
        """Estimates from the prediction. A run that has been slower than predicted is assumed to stay as
        slow."""
        pace = passed / (max(share, LEAST_SHARE) * self._predicted)
        return (1 - share) * self._predicted * max(1, pace) + self._afterwards

    def _by_run(self, passed, fraction, share):
        """Estimates from the run itself. While the program's fraction does not change, the estimate falls with the
        clock."""
        if passed < LEAST_SECONDS or share < LEAST_SHARE:
            return None
        if fraction > self._fraction:
            self._fraction, self._end = fraction, passed / share
        return self._end - passed if self._end > passed else math.inf
