"""Homes a simulated machine, moves it, presses its emergency stop in mid line, and recovers.

    PYTHONPATH=build/release/python .venv/bin/python examples/home_and_stop.py

With `trammel serve --world default`, `card = trammel.open(URL)` and `world = trammel.open_world(URL)` do the same there.
"""
import pathlib

import trammel

SECOND = 1_000_000_000  # ns


def line(machine, card, way_mm, seconds):
    """A straight line by a way in mm, by axis of the machine."""
    card.start_line(machine.pulses_of(way_mm), duration_ns=round(seconds * SECOND))


def places(machine, card):
    return ", ".join(f"{at:.1f}" for at in card.read_coordinates(machine))


def main():
    machine = trammel.Machine(str(pathlib.Path(__file__).with_name("first-machine.toml")))
    card = trammel.simulate_in_world()  # the default world: carriages, switches, an emergency stop button
    world = card.world
    homed = card.home(machine, say=print)
    print("homed", "".join(axis.letter for axis in homed), "at", places(machine, card), "mm")

    line(machine, card, [60, 30, -10], seconds=2)
    world.press("estop", when="X > -70")  # mm from where the machine stood at the beginning
    try:
        card.wait_until_idle(SECOND)
    except trammel.FaultError as stopped:
        print(stopped)
    card.wait_until_stopped()
    print(f"X stands at {card.read_coordinates(machine)[0]:.2f} mm; pressed:", world.state()["pressed"])

    world.release("estop")
    card.clear_faults()
    card.home(machine)  # the power was off: who knows where the carriages have rolled to
    print("back at", places(machine, card), "mm; lost steps:", [axis["lost"] for axis in world.state()["axes"]])


if __name__ == "__main__":
    main()
