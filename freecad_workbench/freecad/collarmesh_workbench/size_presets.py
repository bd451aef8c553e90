"""Named sizes that fit the shape, from very coarse to very fine."""

import math

from . import numbers_typed
from .translations import translate

DEFAULT_PART_OF_DIAGONAL = 1 / 20  # the program's default, as in the medium preset
DAY, YEAR = 86400, 365 * 86400  # seconds
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def presets(diagonal):
    """Returns names and target edge lengths for a shape with a bounding box of this diagonal (mm)."""
    names = (
        (translate("collarmesh", "Very coarse"), 4),
        (translate("collarmesh", "Coarse"), 2),
        (translate("collarmesh", "Medium"), 1),
        (translate("collarmesh", "Fine"), 1 / 2),
        (translate("collarmesh", "Very fine"), 1 / 4),
    )
    return [(name, rounded(factor * diagonal * DEFAULT_PART_OF_DIAGONAL)) for name, factor in names]


def rounded(length, digits=2):
    """Rounds to this many significant digits."""
    return round(length, digits - 1 - math.floor(math.log10(length))) if length > 0 else 0


def count_text(count):
    """Returns a rounded number of elements as text: 12 000."""
    if count >= 1e9:
        mantissa, exponent = f"{count:.0e}".split("e")
        return f"{mantissa}·10" + str(int(exponent)).translate(SUPERSCRIPTS)
    return numbers_typed.grouped(int(rounded(count)))


def duration_text(seconds):
    """Returns a rounded duration as text."""
    if seconds < 1:
        return translate("collarmesh", "< 1 s")
    if seconds < 100:
        return translate("collarmesh", "{n} s").format(n=round(seconds))
    if seconds < 6000:
        return translate("collarmesh", "{n} min").format(n=round(seconds / 60))
    if seconds < 3 * DAY:
        return translate("collarmesh", "{n} h").format(n=round(seconds / 3600, 1))
    if seconds < YEAR:
        return translate("collarmesh", "{n} days").format(n=round(seconds / DAY))
    return translate("collarmesh", "more than a year")
