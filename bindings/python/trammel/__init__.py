"""The Trammel stepper-motion card from Python: driver, simulated card, interpolators.

Positions and distances are in pulses; times are in nanoseconds of card time (names that end in _ns) or in clocks of the
card. Only one thread at a time may use a card, but any thread may call the request_... methods while another one waits.
"""

from ._trammel import *  # noqa: F403
from ._trammel import __version__, interpolation

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__", "interpolation"]
