"""The Trammel stepper-motion card from Python: driver, simulated card, interpolators.

Positions and ways are in pulses, times in nanoseconds of card time (names that end in _ns) or in clocks of the card.
One thread at a time uses a card; the request_... methods may be called from any thread while another one waits.
"""

from ._trammel import *  # noqa: F403
from ._trammel import __version__, interpolation

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__", "interpolation"]
