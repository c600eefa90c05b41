"""What several stages of the diagnosis decide by."""

from __future__ import annotations

ORDER = 12
PRACTICAL = 1.5  # percent of the RMSE on rows that the fit has not seen
APART = 3.0  # errors of one model for all records over those of one model each
LARGE = 0.05  # of the effort: an error that no small cause explains
OWN = 1e-4  # part of a column that the model's own columns must leave over
LEAST = 0.02  # share of rows in which a joint must move
CLEAN = 1.0 - 0.01 / 2.0  # share of the nulls that stay below the threshold of either kind
EVIDENCE = 6.0  # delta BIC that it takes to name a cause (strong: Kass and Raftery 1995)
# The same with one parameter: its price, the logarithm of some thousand rows, leaves one time in 10,000 by
# chance, and there are many such candidates; at 10 one in 100,000, at 6 with two parameters fewer yet.
ALONE = 10.0
COLOURLESS = 15.0  # the same where the colour of the noise is not known
PASSING = 9.0  # the same of warming: noise's colour is known over a second or two, slower drifts look like it
RATHER = 15.0  # delta BIC that it takes to name it rather than another one that passes
STAYS = 0.5  # of its evidence: a rival that keeps that beside the causes explains something else


def practical(percent: float, narrowed: float) -> float:
    """Percent of the RMSE in a narrowed band that is `percent` in the usual one.

    A band `narrowed` times as wide has that many times the power of white noise, and the cause as much as
    before: what is worth naming does not become less for being seen better.
    """
    odds = narrowed * ((1.0 - percent / 100.0) ** -2 - 1.0)  # power of the cause over that of the noise
    return 100.0 * (1.0 - float((1.0 + odds) ** -0.5))
