"""Every class, method, property and function of the Python package has a docstring."""
import enum
import inspect
import unittest

import trammel

SPECIAL = {"__enter__", "__exit__", "__init__", "__iter__", "__next__"}


def is_public(name):
    return not name.startswith("_") or name in SPECIAL


def text_of(thing):
    """The docstring without the signature that nanobind puts before it."""
    if isinstance(thing, enum.Enum):  # without a docstring of its own it inherits that of its class
        return vars(thing).get("__doc__") or ""
    signature = f"{getattr(thing, '__name__', '')}("
    lines = (thing.__doc__ or "").splitlines()
    return " ".join(line for line in lines if not line.startswith(signature)).strip()


def walk(path, owner):
    """(path, thing) of the public classes, functions, methods and properties of a module or class, constants apart."""
    for name, thing in vars(owner).items():
        if not is_public(name) or isinstance(thing, (int, str, list)) and not isinstance(thing, enum.Enum):
            continue
        yield f"{path}.{name}", thing
        if inspect.isclass(thing) or inspect.ismodule(thing):
            yield from walk(f"{path}.{name}", thing)


class Docstrings(unittest.TestCase):
    def test_all(self):
        found = dict(walk("trammel", trammel))
        self.assertEqual(sorted(path for path, thing in found.items() if not text_of(thing)), [])
        for path in ("trammel.Card", "trammel.Card.stop", "trammel.Card.pin_steps", "trammel.Status.busy", "trammel.open",
                     "trammel.StepMode.UP_DOWN", "trammel.HeldError", "trammel.Stream.__init__",
                     "trammel.interpolation.Interpolator.__next__"):
            self.assertIn(path, found)


if __name__ == "__main__":
    unittest.main()
